//! Small buildings for unit tests.

use serde_json::{Value, json};

use crate::input::description::Description;

/// The parameters of a description while it is written.
#[derive(Default)]
struct Numbers(Vec<Value>);

impl Numbers {
    /// Adds a parameter; its index.
    fn add(&mut self, value: f64) -> usize {
        self.0.push(json!({ "path": format!("number.{}", self.0.len()), "value": value }));
        self.0.len() - 1
    }

    fn site(&mut self) -> Value {
        json!({
            "altitude": self.add(0.0),
            "ground_reflectance": self.add(0.2),
            "wind": {
                "mast_height": self.add(10.0), "mast_exponent": self.add(0.14), "mast_layer": self.add(270.0),
                "exponent": self.add(0.22), "layer": self.add(370.0),
            },
            "sky": { "kind": "offset", "depression": self.add(10.0) },
            "cloud": [self.add(0.0), self.add(0.0), self.add(0.0)],
            "diffuse": "perez",
        })
    }

    /// A wall of 5 cm of board in two nodes.
    fn board(&mut self) -> [Value; 2] {
        let material = json!({
            "kind": "solid", "conductivity": self.add(0.16), "density": self.add(800.0), "specific_heat": self.add(1000.0),
        });
        let layer = json!({ "name": "board", "material": 0, "thickness": self.add(0.05), "nodes": 2 });
        [material, json!({ "name": "wall", "layers": [layer] })]
    }

    fn zone(&mut self, volume: f64, longwave: &str, sun: &str) -> Value {
        json!({
            "name": "zone", "volume": self.add(volume), "capacity_factor": self.add(1.0),
            "infiltration": { "constant": self.add(0.5), "temperature": self.add(0.0), "wind": self.add(0.0) },
            "longwave": { "kind": longwave }, "sun": { "kind": sun },
        })
    }

    fn outdoors(&mut self) -> Value {
        json!({
            "facing": { "kind": "outdoors" },
            "convection": { "kind": "linear_wind", "constant": self.add(4.0), "wind": self.add(4.0) },
            "emissivity": self.add(0.9), "absorptance": self.add(0.6),
        })
    }

    fn inside(&mut self, zone: usize) -> Value {
        json!({
            "facing": { "kind": "zone", "zone": zone },
            "convection": { "kind": "constant", "coefficient": self.add(3.0) },
            "emissivity": self.add(0.9), "absorptance": self.add(0.55),
        })
    }

    /// A wall: area [m2], tilt and azimuth [deg], sides.
    fn wall(&mut self, [area, tilt, azimuth]: [f64; 3], [outside, inside]: [Value; 2]) -> Value {
        json!({
            "name": "wall", "construction": 0,
            "area": self.add(area), "tilt": self.add(tilt), "azimuth": self.add(azimuth),
            "outside": outside, "inside": inside,
        })
    }

    fn describe(self, mut rest: Value) -> Description {
        rest["parameters"] = Value::Array(self.0);
        serde_json::from_value(rest).expect("a description")
    }
}

/// Zones in a row: each with a wall outdoors, and a wall of board between each two.
pub(crate) fn zones_in_a_row(count: usize) -> Description {
    let mut numbers = Numbers::default();
    let [material, construction] = numbers.board();
    let zones: Vec<Value> = (0..count).map(|_| numbers.zone(50.0, "none", "area")).collect();
    let mut walls = Vec::new();
    for zone in 0..count {
        let sides = [numbers.outdoors(), numbers.inside(zone)];
        walls.push(numbers.wall([10.0, 90.0, 180.0], sides));
        if zone + 1 < count {
            let sides = [numbers.inside(zone), numbers.inside(zone + 1)];
            walls.push(numbers.wall([12.0, 90.0, 90.0], sides));
        }
    }
    let site = numbers.site();
    numbers.describe(json!({
        "site": site, "materials": [material], "constructions": [construction], "zones": zones, "surfaces": walls,
    }))
}

/// Position of the window among the walls of [`glazed_zone`]; the walls before it are [`BOX`].
pub(crate) const WINDOW: usize = 6;

/// Tilt, azimuth [deg] and vertices [m] of the walls of a zone of 8 m by 6 m by 2.7 m: south, north, east, west, floor, roof.
#[rustfmt::skip]
const BOX: [([f64; 2], [[f64; 3]; 4]); 6] = [
    ([90.0, 180.0], [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [8.0, 0.0, 2.7], [0.0, 0.0, 2.7]]),
    ([90.0, 0.0], [[8.0, 6.0, 0.0], [0.0, 6.0, 0.0], [0.0, 6.0, 2.7], [8.0, 6.0, 2.7]]),
    ([90.0, 90.0], [[8.0, 0.0, 0.0], [8.0, 6.0, 0.0], [8.0, 6.0, 2.7], [8.0, 0.0, 2.7]]),
    ([90.0, 270.0], [[0.0, 6.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.7], [0.0, 6.0, 2.7]]),
    ([180.0, 0.0], [[0.0, 0.0, 0.0], [0.0, 6.0, 0.0], [8.0, 6.0, 0.0], [8.0, 0.0, 0.0]]),
    ([0.0, 0.0], [[0.0, 0.0, 2.7], [8.0, 0.0, 2.7], [8.0, 6.0, 2.7], [0.0, 6.0, 2.7]]),
];

/// A zone with a window of 3 m by 2 m in its south wall, 0.2 m above the floor; with an overhang of 1 m over the whole south
/// wall, or without. `sun` is the law by which the transmitted sun is distributed.
pub(crate) fn glazed_zone(sun: &str, overhang: bool) -> Description {
    let mut numbers = Numbers::default();
    let [material, construction] = numbers.board();
    let zone = numbers.zone(129.6, "radiosity", sun);
    let area = numbers.add(6.0);
    let mut walls: Vec<Value> = BOX
        .iter()
        .map(|(place, vertices)| {
            let area = match place {
                [90.0, azimuth] if azimuth % 180.0 == 0.0 => 21.6,
                [90.0, _] => 16.2,
                _ => 48.0,
            };
            let sides = [numbers.outdoors(), numbers.inside(0)];
            let mut wall = numbers.wall([area, place[0], place[1]], sides);
            wall["vertices"] = json!(vertices);
            wall
        })
        .collect();
    walls[0]["openings"] = json!([area]);
    let mut sides = [numbers.outdoors(), numbers.inside(0)];
    for side in &mut sides {
        side["absorptance"] = Value::Null;
    }
    let mut window = numbers.wall([6.0, 90.0, 180.0], sides);
    window["construction"] = json!(1);
    window["vertices"] = json!([[0.5, 0.0, 0.2], [3.5, 0.0, 0.2], [3.5, 0.0, 2.2], [0.5, 0.0, 2.2]]);
    walls.push(window);
    let glass = json!({ "name": "glass", "glazing": {
        "kind": "simple", "u_value": numbers.add(2.1), "solar_heat_gain": numbers.add(0.7), "panes": numbers.add(2.0),
        "category": numbers.add(4.0), "films": [numbers.add(0.04), numbers.add(0.13)],
    } });
    let shades = if overhang {
        json!([[[0.0, 0.0, 2.7], [8.0, 0.0, 2.7], [8.0, -1.0, 2.7], [0.0, -1.0, 2.7]]])
    } else {
        json!([])
    };
    let site = numbers.site();
    numbers.describe(json!({
        "site": site, "materials": [material], "constructions": [construction, glass], "zones": [zone],
        "surfaces": walls, "shades": shades,
    }))
}

/// The nominal values of the parameters.
pub(crate) fn values(description: &Description) -> Vec<f64> {
    description.parameters.iter().map(|parameter| parameter.value).collect()
}
