//! Ways of the sun through windows between zones.

use super::ids::SideId;
use super::layout::ZonePlan;

/// One direction through a window between two zones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Passage {
    /// Position of the window in [`Plan::windows`](super::plan::Plan::windows).
    pub window: usize,
    /// Zone that the sun comes from, and the place of the window among its surfaces.
    pub from: (usize, usize),
    /// Zone that it enters, and the place of the window among its surfaces.
    pub to: (usize, usize),
    /// Whether it goes from the outside of the window to its inside.
    pub inwards: bool,
}

impl Passage {
    /// All passages of a building: of each window between zones the way in and the way out.
    pub(crate) fn all(windows: &[usize], zones: &[ZonePlan]) -> Vec<Self> {
        let place = |surface: SideId| {
            zones.iter().enumerate().find_map(|(z, zone)| {
                zone.surfaces.iter().position(|&other| other == surface).map(|i| (z, i))
            })
        };
        let both = windows.iter().enumerate().filter_map(|(window, &w)| {
            let [outside, inside] = SideId::pair(w).map(place);
            let (outside, inside) = (outside?, inside?);
            Some([
                Self { window, from: outside, to: inside, inwards: true },
                Self { window, from: inside, to: outside, inwards: false },
            ])
        });
        both.flatten().collect()
    }
}
