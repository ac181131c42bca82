//! The laws together: slopes, heat of melting, tables.

use super::*;
use crate::input::description::{MeltingCurve, ParamId, TablePoints};
use crate::number::dual::Dual;

type D = Dual<1>;

fn ids<const N: usize>(first: u32) -> [ParamId; N] {
    core::array::from_fn(|i| ParamId(first + u32::try_from(i).unwrap()))
}

fn check_slopes(law: &PcmLaw, numbers: &[f64]) {
    let numbers: Vec<D> = numbers.iter().map(|&v| D::constant(v)).collect();
    let pcm = PcmCoefficients::new(&Values::new(&numbers), ids(0), ids(2), ids(4), law);
    let memory = PcmHistory::new(D::zero(), D::zero());
    let mut last = f64::NEG_INFINITY;
    for i in 0..400 {
        let t = 10.0 + 0.083 * f64::from(i);
        let point = pcm.at(D::variable(t, 0), &memory);
        assert!((point.enthalpy.slope[0] / point.capacity.value - 1.0).abs() < 1e-9, "capacity at {t}");
        let slope = point.conductivity.slope[0] - point.conductivity_slope.value;
        assert!(slope.abs() < 1e-12, "conductivity at {t}");
        let slope = point.potential.slope[0] - point.conductivity.value;
        assert!(slope.abs() < 1e-12, "potential at {t}");
        assert!(point.enthalpy.value > last);
        last = point.enthalpy.value;
    }
}

/// Energain, reference/paper Table 2.
const ENERGAIN: [f64; 6] = [0.22, 0.18, 855.0, 855.0, 3134.0, 2833.0];

#[test]
fn capacity_is_the_derivative_of_enthalpy() {
    let [latent_heat, melting_temperature, gamma, delta_t] = ids(6);
    let curve = MeltingCurve::TanhGamma { melting_temperature, gamma, delta_t };
    let law = PcmLaw::Melting { latent_heat, curve };
    check_slopes(&law, &[&ENERGAIN[..], &[71e3, 23.4, 0.04, 0.01]].concat());
    let [temperature_shift, enthalpy_scale] = ids(6);
    let law = PcmLaw::Tabulated {
        temperatures: vec![15.0, 20.0, 22.0, 23.0, 25.0, 30.0],
        points: TablePoints::Enthalpies(vec![0.0, 16e3, 40e3, 70e3, 90e3, 104e3]),
        melting_range: [18.0, 25.0],
        temperature_shift,
        enthalpy_scale,
    };
    check_slopes(&law, &[&ENERGAIN[..], &[0.4, 1.1]].concat());
}

#[test]
fn melting_takes_up_the_latent_heat() {
    let [latent_heat, melting_temperature, width] = ids(6);
    let law = PcmLaw::Melting { latent_heat, curve: MeltingCurve::TanhWidth { melting_temperature, width } };
    let numbers = [&ENERGAIN[..], &[71e3, 23.4, 1.0]].concat();
    let pcm = PcmCoefficients::new(&Values::new(&numbers), ids(0), ids(2), ids(4), &law);
    let memory = PcmHistory::new(0.0, 0.0);
    let rise = pcm.at(33.4, &memory).enthalpy - pcm.at(13.4, &memory).enthalpy;
    let expected = 855.0 * (71e3 + 10.0 * 3134.0 + 10.0 * 2833.0);
    assert!((rise / expected - 1.0).abs() < 1e-7);
}

#[test]
fn table_passes_through_its_points() {
    let [temperature_shift, enthalpy_scale] = ids(6);
    let (temperatures, enthalpies) = (vec![10.0, 20.0, 24.0, 40.0], vec![0.0, 20e3, 90e3, 130e3]);
    let law = PcmLaw::Tabulated {
        temperatures: temperatures.clone(),
        points: TablePoints::Enthalpies(enthalpies.clone()),
        melting_range: [20.0, 24.0],
        temperature_shift,
        enthalpy_scale,
    };
    let numbers = [&ENERGAIN[..], &[0.0, 1.0]].concat();
    let pcm = PcmCoefficients::new(&Values::new(&numbers), ids(0), ids(2), ids(4), &law);
    let memory = PcmHistory::new(0.0, 0.0);
    for (t, h) in temperatures.iter().zip(&enthalpies) {
        assert!((pcm.at(*t, &memory).enthalpy - 855.0 * h).abs() < 1e-6 * 855.0 * 130e3);
    }
}
