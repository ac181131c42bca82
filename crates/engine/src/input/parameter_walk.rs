//! Visits every parameter id of a description.
//!
//! A struct is taken apart field by field, without `..`: a new field does not compile until it is named here, either among the
//! parts that hold parameter ids or, after `plain`, among those that do not.

use core::fmt::{Display, Write};

use super::description::{
    AirPath, Angular, Band, Blind, Buffer, ChannelBand, Clouds, Construction, Convection, Depth,
    DerivedOutput, Description, DirectedFlow, Door, Drying, Facing, FlowDensity, FormulaNumber, FrameShare,
    Gain, Gap, Glazing, HeatExchange, HeatFlux, HeatSource, HeatingMeans, Humidity, HumidityControl,
    HumiditySetPoint, IdealLoad, Infiltration, Layer, Material, MeltingCurve, Mixing, Opening,
    OutdoorLongwave, Pane, PaneOptics, ParamId, PcmLaw, PublishedLaw, Sensor, SetPoint, Side, Site, Sky,
    Sorption, Stratification, SunShares, Surface, TextLaw, ThermalBridge, Throttle, UnitFlow, VapourGain,
    Vent, VentControl, Ventilation, VentilationUnit, WindOnVent, WindPressure, WindProfile, Zone,
    ZoneHumidity, ZoneLongwave, ZoneSun,
};

/// Gets each parameter id and its place in the description, e.g. `surfaces[3].outside.emissivity`.
pub(crate) struct Walk<F> {
    place: String,
    visit: F,
}

impl<F: FnMut(&str, ParamId)> Walk<F> {
    /// Visits all parameter ids of a description in the order of its fields.
    pub(crate) fn over(description: &Description, visit: F) {
        description.parameter_ids(&mut Self { place: String::new(), visit });
    }

    /// Visits a part at a place below the present one.
    fn below(&mut self, name: impl Display, part: &impl ParameterIds) {
        let length = self.place.len();
        // Writing to a string cannot fail.
        let _ = write!(self.place, "{name}");
        part.parameter_ids(self);
        self.place.truncate(length);
    }

    fn field(&mut self, name: &str, part: &impl ParameterIds) {
        let dot = if self.place.is_empty() { "" } else { "." };
        self.below(format_args!("{dot}{name}"), part);
    }
}

/// A part of a description that may hold parameter ids.
trait ParameterIds {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>);
}

impl ParameterIds for ParamId {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        (walk.visit)(&walk.place, *self);
    }
}

impl<T: ParameterIds> ParameterIds for Option<T> {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        if let Some(part) = self {
            part.parameter_ids(walk);
        }
    }
}

impl<T: ParameterIds> ParameterIds for [T] {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        for (index, part) in self.iter().enumerate() {
            walk.below(format_args!("[{index}]"), part);
        }
    }
}

impl<T: ParameterIds, const N: usize> ParameterIds for [T; N] {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        self.as_slice().parameter_ids(walk);
    }
}

impl<T: ParameterIds> ParameterIds for Vec<T> {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        self.as_slice().parameter_ids(walk);
    }
}

/// Implements the walk: fields that hold parameter ids, then, after `plain`, those that do not.
macro_rules! walk {
    ($name:ident { $($part:ident),* } plain { $($plain:ident),* }) => {
        impl ParameterIds for $name {
            fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
                let Self { $($part,)* $($plain: _,)* } = self;
                $(walk.field(stringify!($part), $part);)*
            }
        }
    };
    ($name:ident by variant { $($variant:ident { $($part:ident),* } plain { $($plain:ident),* }),* $(,)? }) => {
        impl ParameterIds for $name {
            fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
                match self {
                    $(Self::$variant { $($part,)* $($plain: _,)* } => {
                        $(walk.field(stringify!($part), $part);)*
                    })*
                }
            }
        }
    };
}

walk!(Description { site, materials, constructions, zones, air_paths, directed_flows, doors, ventilation_units,
    thermal_bridges, openings, vents, controls, surfaces, heat_sources, sensors, humidity, outputs }
    plain { parameters, shades, channels });

walk!(Site { altitude, air_density, air_specific_heat, ground_reflectance, wind, sky, cloud, sky_exponent,
    sky_diurnal } plain { diffuse, horizon });
impl ParameterIds for Clouds {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        match self {
            Self::Factor(coefficients) => coefficients.parameter_ids(walk),
            Self::Layer { emissivity, base } => {
                walk.field("emissivity", emissivity);
                walk.field("base", base);
            }
        }
    }
}
walk!(WindProfile { mast_height, mast_exponent, mast_layer, exponent, layer } plain {});
impl ParameterIds for Sky {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        match self {
            Self::Law(law) => law.parameter_ids(walk),
            Self::Text { temperature: _, law } => walk.field("law", law),
        }
    }
}
impl ParameterIds for PublishedLaw {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        self.numbers.iter().for_each(|(name, id)| walk.field(name, id));
    }
}

walk!(Material by variant {
    Solid { conductivity, density, specific_heat } plain {},
    Variable { conductivity, density, specific_heat } plain {},
    Resistance { resistance } plain {},
    Rated { u_value } plain {},
    Pcm { conductivity, density, specific_heat, law } plain {},
});
walk!(PcmLaw by variant {
    Melting { latent_heat, curve } plain {},
    History { latent_heat, curves, numbers } plain { model },
    Tabulated { temperature_shift, enthalpy_scale } plain { temperatures, points, melting_range },
});
walk!(MeltingCurve by variant {
    TanhWidth { melting_temperature, width } plain {},
    TanhGamma { melting_temperature, gamma, delta_t } plain {},
    SmoothStep { melting_temperature, width } plain { continuity },
    Gaussian { melting_temperature, width } plain {},
    Gumbel { melting_temperature, width } plain { tail },
    Linear { melting_temperature, width } plain {},
    Triangle { melting_temperature, below, above } plain {},
    Fractions { temperature_shift } plain { temperatures, fractions },
    Text { melting_temperature, numbers } plain { formula, range },
});

walk!(Construction { layers, glazing, blind } plain { name });
walk!(Blind { transmittance, reflectance, resistance, cover, radiation, to_air } plain { inside, schedule });
walk!(Layer { thickness } plain { name, material, nodes });
walk!(Glazing by variant {
    Panes { panes, gaps, angular } plain {},
    Simple { u_value, solar_heat_gain, transmittance, panes, category, surface_resistances } plain {},
});
walk!(Pane { thickness, conductivity, storage, emissivity, optics } plain {});
walk!(PaneOptics { transmittance, reflectance } plain { coated });
walk!(Gap by variant {
    Given { conductance } plain {},
    Filled { thickness, pressure } plain { gas },
});
walk!(Angular { transmittance_scale, absorptance_scale }
    plain { angles, transmittance, absorptance, diffuse_transmittance, diffuse_absorptance, back_transmittance,
        back_absorptance });

walk!(Zone { volume, capacity_factor, infiltration, longwave, sun, solar_to_air, gains, ventilation, mixing, stratification, heating, cooling, setpoint_radiant_share }
    plain { name, view_weights, makeup_by_vents });
walk!(Mixing { air_changes } plain { schedule });
walk!(Stratification { gradient } plain { schedule, height });
walk!(Infiltration { constant, temperature, wind, leakage, law, density } plain { schedule, control });
walk!(FlowDensity by variant {
    Outdoors {} plain {},
    Zone {} plain {},
    Constant { value } plain {},
});
walk!(DerivedOutput { law } plain { name, of });
walk!(TextLaw { numbers } plain { formula, valid });
walk!(ZoneLongwave by variant {
    Radiosity {} plain {},
    Linearised { reference } plain {},
    None {} plain {},
});
walk!(ZoneSun by variant {
    Area {} plain {},
    Shares { surfaces, lost, diffuse } plain {},
    Floor {} plain { floor },
    Geometry {} plain {},
});
walk!(SunShares { faces, lost } plain {});
walk!(Gain { power, radiative, activity } plain { name, schedule });
walk!(Ventilation { air_changes, flow, density } plain { name, schedule, control });
walk!(IdealLoad { setpoint, capacity, radiative } plain { schedule });
walk!(SetPoint by variant {
    Constant { temperature } plain {},
    Scheduled {} plain { channel },
});
walk!(AirPath { flow, density } plain { name, between, schedule, control });
walk!(DirectedFlow { flow, density } plain { name, from, to, schedule });
walk!(Door { width, height, discharge, open } plain { name, between, schedule, control });
walk!(UnitFlow { flow, density } plain { zone, schedule });
walk!(VentilationUnit { supply, exhaust, temperature, recovery } plain { name });
walk!(ThermalBridge { coefficient, size, to } plain { name, zone });
walk!(Opening { area, height, discharge, wind_coefficient } plain { name, zone, schedule, control });
walk!(Vent { area, height, elevation, discharge, exponent, wind } plain { name, zone, to, schedule, control });
walk!(WindOnVent { azimuth, height, shelter, pressure } plain {});
walk!(WindPressure by variant {
    LowRise { side_ratio } plain {},
    Table {} plain { coefficients },
});
walk!(VentControl { indoor, outdoor, indoor_below, outdoor_below, difference, wind, rain, minimum_open_time,
    minimum_closed_time } plain { name, zone, reference_zone });
walk!(Band { open, close } plain {});
walk!(ChannelBand { band } plain { channel });

walk!(Surface { area, openings, frame, cavity_height, tilt, azimuth, outside, inside }
    plain { name, construction, vertices, soil });
walk!(FrameShare { fraction } plain { is_frame });
walk!(Side { facing, convection, heat_flux, emissivity, absorptance, area_factor, sky_view, ground_view, height, longwave }
    plain { irradiance, behind_obstacles, exposure, shaded_by, own_shades, outline, level });
walk!(HeatFlux { flux } plain { schedule });
walk!(HeatSource { means, thermostat } plain { name, surface, layer, control });
walk!(HeatingMeans by variant {
    Electric { power } plain { schedule },
    Water { flow, supply, specific_heat, exchange } plain { schedule },
});
walk!(HeatExchange by variant {
    Conductance { conductance } plain {},
    Effectiveness { effectiveness } plain {},
});
walk!(Throttle { setpoint, range } plain { zone, cooling });
walk!(Facing by variant {
    Outdoors {} plain {},
    Zone {} plain { zone },
    Imposed { law } plain {},
    Measured {} plain { channel },
    Adiabatic {} plain {},
});
walk!(OutdoorLongwave by variant {
    Exact {} plain {},
    Linearised { reference } plain {},
    None {} plain {},
});
impl ParameterIds for Convection {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        match self {
            Self::Law(law) => law.parameter_ids(walk),
            Self::Measured { channel: _, factor } => walk.field("factor", factor),
            Self::Formula { formula: _, valid: _, numbers } => walk.field("numbers", numbers),
        }
    }
}
walk!(FormulaNumber { value } plain { name });
walk!(Sensor { depth } plain { name, surface });

walk!(Humidity { initial, lewis, zones, buffers, recoveries } plain {});
walk!(ZoneHumidity { storage, gains, drying, humidifying } plain {});
walk!(VapourGain { power, rate, activity } plain { name, schedule });
walk!(Drying by variant {
    Controlled { control } plain {},
    Coil { sensible_heat_ratio, temperature } plain {},
});
walk!(HumidityControl { setpoint, capacity } plain { schedule });
walk!(HumiditySetPoint by variant {
    Relative { humidity } plain {},
    Ratio { ratio } plain {},
    RelativeScheduled {} plain { channel },
    RatioScheduled {} plain { channel },
});
walk!(Buffer { sorption, resistance_factor, thickness, coating, depth, deep } plain { surface, side });
impl ParameterIds for Sorption {
    fn parameter_ids<F: FnMut(&str, ParamId)>(&self, walk: &mut Walk<F>) {
        match self {
            Self::Law(law) => law.parameter_ids(walk),
            Self::Table { humidities: _, contents: _, factor } => walk.field("factor", factor),
        }
    }
}
walk!(Depth by variant {
    Given { depth } plain {},
    Period { period } plain {},
});
