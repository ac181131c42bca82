//! Plane geometry of shading and sunlit patches, without buildings: vertices and directions in, fractions out.
//!
//! Coordinates are east, north, up [m]; polygons turn counter-clockwise seen from outside. All of it is in plain numbers:
//! it depends on vertices and on the direction of the sun alone, which are the same for all members of an ensemble.

pub(crate) mod patches;
pub(crate) mod plane;
pub(crate) mod polygon;
pub(crate) mod shading;
pub(crate) mod surface;

/// Polygons with an area below the square of this length are dropped [m].
pub(crate) const LEAST_LENGTH: f64 = 1e-6;
/// Points closer to a plane than this lie in it [m].
pub(crate) const SAME_PLANE: f64 = 1e-3;
/// Below this cosine of the angle of incidence nothing falls on a surface [-].
pub(crate) const GRAZING: f64 = 1e-6;
