//! Finite volumes of walls, and what they are made of.

/// A finite volume of a wall.
#[derive(Debug, Clone)]
pub struct Cell<S> {
    /// Thickness [m].
    pub thickness: S,
    /// Thermal properties.
    pub matter: Matter<S>,
}

/// Thermal properties of a cell: constant or phase-changing.
#[derive(Debug, Clone)]
pub enum Matter<S> {
    /// Constant properties.
    Solid {
        /// Conductivity [W/(m K)].
        conductivity: S,
        /// Volumetric heat capacity [J/(m3 K)].
        capacity: S,
    },
    /// Index into the phase-change laws of the wall
    /// ([`WallCoefficients::pcm`](crate::building::coefficients::WallCoefficients::pcm)).
    Pcm(usize),
}
