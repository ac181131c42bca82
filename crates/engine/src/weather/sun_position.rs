//! The position of the sun as angles.

use crate::physics::convection::wind::angle_of_cosine;

/// Altitude above the horizon and azimuth clockwise from north, 0 to 360, of a direction (east, north, up) [deg].
///
/// The arccosine is taken of the smaller of two sides of a triangle, where it is steep.
pub(crate) fn position([east, north, up]: [f64; 3]) -> [f64; 2] {
    let level = (east * east + north * north).sqrt();
    let length = (level * level + up * up).sqrt();
    if length == 0.0 {
        return [0.0; 2];
    }
    // The angle of a side from the axis of another one, both not negative.
    let angle = |along: f64, across: f64, length: f64| {
        if across < along { 90.0 - angle_of_cosine(across / length) } else { angle_of_cosine(along / length) }
    };
    let height = angle(level, up.abs(), length);
    let altitude = if up < 0.0 { -height } else { height };
    if level == 0.0 {
        return [altitude, 0.0];
    }
    let acute = angle(north.abs(), east.abs(), level);
    let from_north = if north < 0.0 { 180.0 - acute } else { acute };
    [altitude, if east < 0.0 { 360.0 - from_north } else { from_north }]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: due south at 30 deg, east at the horizon, north-west 45 deg below it, and the zenith.
    #[test]
    fn positions_of_the_sun() {
        let (half, root) = (0.5, 0.75_f64.sqrt());
        let below = 0.5_f64.sqrt();
        let cases = [
            ([0.0, -root, half], [30.0, 180.0]),
            ([1.0, 0.0, 0.0], [0.0, 90.0]),
            ([-half, half, -below], [-45.0, 315.0]),
            ([0.0, 0.0, 1.0], [90.0, 0.0]),
            ([1e-4, -1.0, 0.0], [0.0, 180.0 - 1e-4_f64.to_degrees()]),
        ];
        for (direction, expected) in cases {
            let angles = position(direction);
            for (a, b) in angles.into_iter().zip(expected) {
                assert!((a - b).abs() < 1e-6, "{angles:?}, expected {expected:?}");
            }
        }
    }
}
