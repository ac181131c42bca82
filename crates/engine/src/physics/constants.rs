//! Physical constants that several laws share.

/// Stefan-Boltzmann constant [W/(m2 K4)] (CODATA 2018).
pub const SIGMA: f64 = 5.670_374_419e-8;
/// 0 degC [K] (BIPM, The International System of Units, 9th edition).
pub const KELVIN: f64 = 273.15;
/// Standard gravity [m/s2] (3rd CGPM, 1901).
pub const GRAVITY: f64 = 9.806_65;
/// Molar gas constant [J/(mol K)] (CODATA 2018).
pub const GAS_CONSTANT: f64 = 8.314_462_618;
/// Specific gas constant of dry air [J/(kg K)]: 8314.41/28.9645 (ASHRAE Handbook of Fundamentals 2001, ch. 6).
pub const AIR_GAS_CONSTANT: f64 = 287.055;
/// Specific heat of dry air at indoor temperatures [J/(kg K)] (ASHRAE Handbook of Fundamentals 2017, ch. 1).
pub const AIR_SPECIFIC_HEAT: f64 = 1006.0;
