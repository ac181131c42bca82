//! Polygons, shading and sunlit patches.

pub mod daylight;
