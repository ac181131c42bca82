//! The coefficients of a building: a plan evaluated at a parameter vector, for one run or for a pack of members in lanes.

pub(crate) mod air;
pub(crate) mod bridge;
pub(crate) mod heat_source;
pub(crate) mod humidity;
pub(crate) mod mechanical_air;
pub(crate) mod passing;
pub(crate) mod surface;
pub(crate) mod vents;
pub(crate) mod wall;
pub(crate) mod zone;

pub use self::bridge::{Bridge, BridgeEnd};
pub use self::heat_source::HeatSource;
pub use self::humidity::HumidityCoefficients;
use self::humidity::VapourZone;
pub use self::mechanical_air::MechanicalAir;
pub use self::passing::Passing;
pub use self::surface::{Boundary, Imposed, Outdoors, SurfaceCoefficients};
pub use self::vents::Vents;
pub use self::wall::WallCoefficients;
pub use self::zone::ZoneCoefficients;
pub use super::cell::{Cell, Matter};
use super::ids::BySide;
use super::plan::Plan;
use crate::input::description::DerivedOutput;
use crate::input::values::Values;
use crate::number::real::Real;
use crate::physics::air_flow::Path;
use crate::physics::doors::Door;
use crate::physics::flow_density::SiteAir;
use crate::physics::formula::expression::Expression;
use crate::physics::gains::Gain;
use crate::physics::longwave::SkyEmission;

/// All coefficients of a run.
#[derive(Debug, Clone)]
pub struct Coefficients<S> {
    /// Walls.
    pub walls: Vec<WallCoefficients<S>>,
    /// The two surfaces of each wall.
    pub surfaces: BySide<SurfaceCoefficients<S>>,
    /// Zones.
    pub zones: Vec<ZoneCoefficients<S>>,
    /// Sun that windows between zones let pass.
    pub passing: Passing<S>,
    /// Air exchanged between zones.
    pub paths: Vec<Path<S>>,
    /// Doors between zones.
    pub doors: Vec<Door<S>>,
    /// Flows that fans drive.
    pub mechanical_air: MechanicalAir<S>,
    /// Air of the site, where flows are volumes of air of a density that changes.
    pub(crate) densities: Option<SiteAir<S>>,
    /// Whether the air of a zone is stratified.
    pub(crate) has_stratified: bool,
    /// Whether people give heat or vapour by the temperature of the air.
    pub(crate) has_people: bool,
    /// Openings of the pressure network, and controls of openings.
    pub vents: Vents<S>,
    /// Thermal bridges.
    pub bridges: Vec<Bridge<S>>,
    /// Heat released between layers of walls.
    pub heat_sources: Vec<HeatSource<S>>,
    /// Solar reflectance of the ground [-].
    pub ground_reflectance: S,
    /// Emission of the sky.
    pub sky: SkyEmission<S>,
    /// Vapour balance of the zones.
    pub humidity: Option<HumidityCoefficients<S>>,
    /// Outputs that are derived from others.
    pub(crate) outputs: Vec<Expression<S>>,
    /// Depth of each sensor from the outside surface [m].
    pub sensor_depths: Vec<S>,
}

impl<S: Real> Coefficients<S> {
    /// Evaluates a plan at a parameter vector.
    #[must_use]
    pub fn new(plan: &Plan, numbers: &[S]) -> Self {
        let values = Values::new(numbers);
        let description = &plan.description;
        let walls: Vec<_> = (0..plan.walls.len()).map(|i| WallCoefficients::new(plan, i, &values)).collect();
        let surfaces: BySide<_> =
            plan.surfaces.ids().map(|i| SurfaceCoefficients::new(plan, i, &values)).collect();
        let site = &description.site;
        let air = air::of_site(plan, &values);
        let zones: Vec<_> = (0..plan.zones.len())
            .map(|i| ZoneCoefficients::new(plan, i, &values, &walls, &surfaces, &air))
            .collect();
        let passing = Passing::new(plan, &walls, &zones);
        let paths = description.air_paths.iter().map(|path| Path::new(path, &values, &air)).collect();
        let humidity = HumidityCoefficients::new(plan, &values, &walls, &zones);
        let heat_sources = description.heat_sources.iter().enumerate();
        let heat_sources = heat_sources.map(|source| HeatSource::new(plan, source, &values, &walls));
        let surfaces_described = description.surfaces.iter().enumerate();
        let soil = surfaces_described.filter_map(|(index, surface)| Some((index, surface.soil.as_ref()?)));
        let heat_sources =
            heat_sources.chain(soil.flat_map(|soil| HeatSource::of_soil(plan, soil))).collect();
        let has_people = zones.iter().flat_map(|zone| &zone.gains).any(Gain::of_people)
            || humidity.iter().flat_map(|humidity| &humidity.zones).any(VapourZone::has_people);
        Self {
            has_stratified: zones.iter().any(|zone| zone.gradient.is_some()),
            has_people,
            heat_sources,
            humidity,
            walls,
            surfaces,
            zones,
            passing,
            paths,
            doors: description.doors.iter().map(|door| Door::new(door, &values, air.heat)).collect(),
            mechanical_air: MechanicalAir::new(plan, &values, &air),
            densities: air::density_varies(plan).then_some(air),
            vents: Vents::new(plan, &values),
            bridges: description.thermal_bridges.iter().map(|bridge| Bridge::new(bridge, &values)).collect(),
            ground_reflectance: values.get(site.ground_reflectance),
            sky: SkyEmission::new(site, &values),
            outputs: description.outputs.iter().map(|output| derived(output, &values)).collect(),
            sensor_depths: description.sensors.iter().map(|sensor| values.get(sensor.depth)).collect(),
        }
    }
}

/// The formula of a derived output.
fn derived<S: Real>(output: &DerivedOutput, values: &Values<'_, S>) -> Expression<S> {
    let names: Vec<&str> = output.of.iter().map(|used| used.name.as_str()).collect();
    Expression::of(&output.law, &names, values)
}
