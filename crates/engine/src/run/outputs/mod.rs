//! What a run records: the table of all outputs. All that is said of an output anywhere follows from its row.

pub(crate) mod row;
mod values;

use serde::Deserialize;

use crate::building::ids::SideId;
use crate::building::plan::Plan;
use crate::error::EngineError;
use crate::number::real::Real;
use crate::physics::formula::expression::MOST;
use crate::physics::globe::globe_temperature;
use crate::physics::psychrometrics::{dew_point, relative_humidity, wet_bulb};
use crate::step::readings::Readings;
use crate::step::state::State;

use row::{At, Place, is_kind, outputs, require};
pub use row::{Entry, Of, Row, Time};
use values::{
    interface_temperature, layer_flux, layer_mean, mean_radiant, sensor_temperature, solar_transmittance,
    transmitted,
};

outputs! {
    /// Temperature of the air.
    AirTemperature { zone } =
        Row::state(Of::Zone, "ZONE.air_temperature", "degC", "Air temperature").usual(),
        |at| at.state.air[zone];

    /// Mean of the surface temperatures of the zone, weighted by area, and what the radiation of ideal loads adds; without view factors to a point and without emissivities.
    MeanRadiantTemperature { zone } =
        Row::state(Of::Zone, "ZONE.mean_radiant_temperature", "degC", "Mean radiant temperature"),
        |at| mean_radiant(&at, zone);

    /// Mean of the air and the mean radiant temperature.
    OperativeTemperature { zone } =
        Row::state(Of::Zone, "ZONE.operative_temperature", "degC", "Operative temperature"),
        |at| (at.state.air[zone] + mean_radiant(&at, zone)).scale(0.5);

    /// Temperature of a black globe of 0.15 m between the air and the mean radiant temperature.
    GlobeTemperature { zone } =
        Row::state(Of::Zone, "ZONE.globe_temperature", "degC", "Globe temperature"),
        |at| globe_temperature(at.state.air[zone], mean_radiant(&at, zone), S::constant(0.15), S::constant(0.95));

    /// Heat that ideal heating supplies to the air, not below 0.
    HeatingLoad { zone } =
        Row::mean(Of::HeatedZone, "ZONE.heating_load", "W", "Heating"),
        |at| at.state.load[zone].max(S::zero());

    /// Heat that ideal cooling takes from the air, not below 0.
    CoolingLoad { zone } =
        Row::mean(Of::CooledZone, "ZONE.cooling_load", "W", "Cooling"),
        |at| (-at.state.load[zone]).max(S::zero());

    /// Heat that ideal heating brings less what ideal cooling takes.
    NetLoad { zone } =
        Row::mean(Of::ConditionedZone, "ZONE.net_load", "W", "Heating less cooling"),
        |at| at.state.load[zone];

    /// Outdoor air over the volume of the zone: infiltration, ventilation, openings and ventilation units.
    AirChanges { zone } =
        Row::state(Of::Zone, "ZONE.air_changes", "1/h", "Air changes").not_negative(),
        |at| at.step.air_changes(zone, at.state.air[zone]);

    /// Air that flows into the zone from outdoors and by fans from other zones, with that which moves within it.
    TotalAirChanges { zone } =
        Row::state(Of::Zone, "ZONE.total_air_changes", "1/h", "Air moved through and within the zone").not_negative(),
        |at| at.step.total_air_changes(zone, at.state.air[zone]);

    /// Vapour in the air of the zone by mass of dry air.
    HumidityRatio { zone } =
        Row::state(Of::HumidZone, "ZONE.humidity_ratio", "kg/kg", "Humidity ratio").not_negative(),
        |at| at.state.vapour[zone];

    /// Vapour pressure over that of saturated air, over water.
    RelativeHumidity { zone } =
        Row::state(Of::HumidZone, "ZONE.relative_humidity", "-", "Relative humidity").not_negative(),
        |at| relative_humidity(at.state.air[zone], at.state.vapour[zone], at.step.pressure());

    /// Temperature at which the air is saturated over water.
    DewPoint { zone } =
        Row::state(Of::HumidZone, "ZONE.dew_point", "degC", "Dew point"),
        |at| dew_point(at.state.vapour[zone], at.step.pressure());

    /// Temperature of adiabatic saturation of the air.
    WetBulb { zone } =
        Row::state(Of::HumidZone, "ZONE.wet_bulb", "degC", "Wet-bulb temperature"),
        |at| wet_bulb(at.state.air[zone], at.state.vapour[zone], at.step.pressure());

    /// Heat of condensation of the vapour that drying or the cooling coil takes.
    LatentCooling { zone } =
        Row::mean(Of::DriedZone, "ZONE.latent_cooling_load", "W", "Latent cooling").not_negative(),
        |at| at.step.latent(zone, false);

    /// Heat of evaporation of the vapour that humidifying brings.
    LatentHeating { zone } =
        Row::mean(Of::HumidifiedZone, "ZONE.latent_heating_load", "W", "Latent heating").not_negative(),
        |at| at.step.latent(zone, true);

    /// Temperature of the air at the floor, where it is stratified.
    ZoneFloorAir { zone } =
        Row::state(Of::StratifiedZone, "ZONE.floor_air_temperature", "degC", "Air temperature at the floor"),
        |at| at.step.air_at(at.state, zone, -0.5);

    /// Temperature of the air at the ceiling, where it is stratified.
    ZoneCeilingAir { zone } =
        Row::state(Of::StratifiedZone, "ZONE.ceiling_air_temperature", "degC", "Air temperature at the ceiling"),
        |at| at.step.air_at(at.state, zone, 0.5);

    /// Solar radiation that enters through all windows of the zone.
    ZoneTransmittedSolar { zone } =
        Row::mean(Of::SunlitZone, "ZONE.transmitted_solar", "W", "Transmitted solar radiation"),
        |at| at.step.weather.sun.zones[zone];

    /// Solar radiation that leaves the zone again through its windows.
    ZoneLostSolar { zone } =
        Row::mean(Of::SunlitZone, "ZONE.lost_solar", "W", "Lost solar radiation"),
        |at| at.step.weather.sun.lost[zone];

    /// Temperature of the surface.
    FaceTemperature { surface, side } =
        Row::state(Of::Side, "SURFACE.SIDE_temperature, WINDOW.SIDE_temperature", "degC", "Surface temperature").usual(),
        |at| at.state.surfaces[SideId::new(surface, side)];

    /// Temperature between two layers, counted from outside.
    InterfaceTemperature { surface, interface } =
        Row::state(
            Of::Interface,
            "SURFACE.interface_N_temperature or SURFACE.LAYER_LAYER_temperature",
            "degC",
            "Temperature between layers",
        )
        .usual(),
        |at| interface_temperature(&at, surface, interface);

    /// Conduction in the wall at its surface, positive towards the inside.
    FaceFlux { surface, side } =
        Row::mean(Of::Side, "SURFACE.SIDE_flux", "W/m2", "Conduction at the surface"),
        |at| at.step.link_flux(at.state, surface, side * at.plan.walls[surface].len());

    /// Conduction through the middle of a layer, positive towards the inside.
    LayerFlux { surface, layer } =
        Row::mean(Of::Layer, "SURFACE.LAYER_flux", "W/m2", "Conduction in a layer"),
        |at| layer_flux(&at, surface, layer);

    /// Mean temperature of a layer.
    LayerTemperature { surface, layer } =
        Row::state(Of::MeltingLayer, "SURFACE.LAYER_temperature", "degC", "Layer temperature"),
        |at| layer_mean(at.plan, surface, layer, |k| at.state.cells[k]);

    /// Melted part of a layer.
    LiquidFraction { surface, layer } =
        Row::state(Of::MeltingLayer, "SURFACE.LAYER_liquid_fraction", "-", "Liquid fraction")
            .within(0.0, 1.0)
            .usual(),
        |at| layer_mean(at.plan, surface, layer, |k| at.state.memory[k].liquid_fraction);

    /// Mean enthalpy of a layer per volume of the solid, zero for the solid at the melting temperature.
    LayerEnthalpy { surface, layer } =
        Row::state(Of::MeltingLayer, "SURFACE.LAYER_enthalpy", "J/m3", "Enthalpy"),
        |at| layer_mean(at.plan, surface, layer, |k| at.step.enthalpy(at.state, surface, k));

    /// Solar radiation on the surface, after shading.
    IncidentSolar { surface } =
        Row::mean(
            Of::OutdoorSurface,
            "SURFACE.incident_solar, WINDOW.incident_solar",
            "W/m2",
            "Incident solar radiation",
        ),
        |at| at.step.incident(SideId::outside(surface));

    /// The part of it that comes from the sun's disc, after shading; 0 where the irradiance is measured.
    IncidentBeam { surface } =
        Row::mean(
            Of::OutdoorSurface,
            "SURFACE.incident_beam, WINDOW.incident_beam",
            "W/m2",
            "Incident beam radiation",
        ),
        |at| at.step.incident_beam(SideId::outside(surface));

    /// The part of it from sky and ground, that around the sun's disc included; all of it where the irradiance is measured.
    IncidentDiffuse { surface } =
        Row::mean(
            Of::OutdoorSurface,
            "SURFACE.incident_diffuse, WINDOW.incident_diffuse",
            "W/m2",
            "Incident diffuse radiation",
        ),
        |at| at.step.incident(SideId::outside(surface)) - at.step.incident_beam(SideId::outside(surface));

    /// Fraction of the sky that the surface sees, past all obstacles, as diffuse radiation of an isotropic sky counts it.
    SkyView { surface } =
        Row::state(
            Of::OutdoorSurface,
            "SURFACE.sky_view_factor, WINDOW.sky_view_factor",
            "-",
            "View factor to the sky",
        )
        .within(0.0, 1.0),
        |at| at.step.views(SideId::outside(surface))[0];

    /// Fraction of the ground that the surface sees past all obstacles, as radiation from the ground counts it.
    GroundView { surface } =
        Row::state(
            Of::OutdoorSurface,
            "SURFACE.ground_view_factor, WINDOW.ground_view_factor",
            "-",
            "View factor to the ground",
        )
        .within(0.0, 1.0),
        |at| at.step.views(SideId::outside(surface))[1];

    /// Solar radiation that the window transmits; between two zones less what it transmits the other way.
    TransmittedSolar { surface } =
        Row::mean(Of::Window, "WINDOW.transmitted_solar", "W", "Transmitted solar radiation"),
        |at| transmitted(&at, surface);

    /// Transmitted over incident solar radiation on the glass; 0 without sun.
    SolarTransmittance { surface } =
        Row::mean(Of::OutdoorWindow, "WINDOW.solar_transmittance", "-", "Solar transmittance").within(0.0, 1.0),
        |at| solar_transmittance(&at, surface);

    /// Solar radiation that the side of a surface, or all panes of a window, absorb.
    AbsorbedSolar { surface, side } =
        Row::mean(
            Of::SunlitSide,
            "SURFACE.SIDE_absorbed_solar, WINDOW.absorbed_solar",
            "W/m2",
            "Absorbed solar radiation",
        ),
        |at| at.step.weather.absorbed(SideId::new(surface, side));

    /// Long-wave radiation that the side gains from its surroundings.
    NetLongwave { surface, side } =
        Row::state(
            Of::RadiatingSide,
            "SURFACE.SIDE_longwave, WINDOW.SIDE_longwave",
            "W/m2",
            "Net long-wave radiation",
        ),
        |at| at.step.net_longwave(at.state, SideId::new(surface, side));

    /// Convective heat transfer coefficient.
    Convection { surface, side } =
        Row::state(
            Of::ConvectiveSide,
            "SURFACE.SIDE_convection, WINDOW.SIDE_convection",
            "W/(m2 K)",
            "Heat transfer coefficient",
        )
        .not_negative(),
        |at| at.step.convection(at.state, SideId::new(surface, side));

    /// Relative humidity of the air of the zone at the temperature of the surface.
    SurfaceHumidity { surface, side } =
        Row::state(
            Of::HumidSide,
            "SURFACE.SIDE_relative_humidity, WINDOW.SIDE_relative_humidity",
            "-",
            "Relative humidity at the surface",
        )
        .not_negative(),
        |at| at.step.surface_humidity(at.state, SideId::new(surface, side));

    /// 1 where dew, or below 0.01 degC frost, forms on the surface, else 0.
    Condensation { surface, side } =
        Row::state(
            Of::HumidSide,
            "SURFACE.SIDE_condensation, WINDOW.SIDE_condensation",
            "-",
            "Condensation",
        ),
        |at| S::select(at.step.condenses(at.state, SideId::new(surface, side)), S::one(), S::zero());

    /// Air that flows into the zone of the vent, or from the second zone to the first, at the density of the site.
    VentInflow { vent } =
        Row::state(Of::Vent, "VENT.inflow", "m3/s", "Inflow"),
        |at| at.step.vents_now().flows[vent][1];

    /// Air that flows out of the zone of the vent, or from the first zone to the second, at the density of the site.
    VentOutflow { vent } =
        Row::state(Of::Vent, "VENT.outflow", "m3/s", "Outflow"),
        |at| at.step.vents_now().flows[vent][0];

    /// Fraction of the area of the vent that its schedule and control open.
    VentOpen { vent } =
        Row::state(Of::Vent, "VENT.open", "-", "Open fraction").within(0.0, 1.0),
        |at| at.step.vents_now().open[vent];

    /// 1 where the control lets openings open, else 0, during the step.
    ControlOpen { control } =
        Row::state(Of::Control, "CONTROL.open", "-", "Open by the control"),
        |at| at.state.opened[control];

    /// Heat that the heat source gives to its surface; negative: water that takes heat.
    SourceHeat { source } =
        Row::state(Of::Source, "SOURCE.heat", "W", "Heat of a heat source").usual(),
        |at| at.step.released(at.state, source);

    /// Temperature of the plane between the layers in which the heat is released.
    PlaneTemperature { source } =
        Row::state(Of::Source, "SOURCE.plane_temperature", "degC", "Temperature of the plane of a heat source"),
        |at| at.step.plane(at.state, source);

    /// Temperature of the water that leaves the pipes; without flow that of the plane, by a conductance.
    ReturnTemperature { source } =
        Row::state(Of::WaterSource, "SOURCE.return_temperature", "degC", "Return temperature"),
        |at| at.step.returned(at.state, source);

    /// Temperature of a black sky with the same long-wave emission.
    SkyTemperature =
        Row::state(Of::Building, "sky_temperature", "degC", "Sky temperature"),
        |at| at.step.sky_temperature();

    /// Altitude of the sun above the level horizon, negative by night.
    SunAltitude =
        Row::state(Of::Building, "sun_altitude", "deg", "Altitude of the sun").within(-90.0, 90.0),
        |at| S::constant(at.step.sun_position()[0]);

    /// Azimuth of the sun, clockwise from north.
    SunAzimuth =
        Row::state(Of::Building, "sun_azimuth", "deg", "Azimuth of the sun").within(0.0, 360.0),
        |at| S::constant(at.step.sun_position()[1]);

    /// Temperature at a depth of a wall.
    Sensor { sensor } =
        Row::state(Of::Sensor, "SENSOR.temperature", "degC", "Temperature of a sensor").usual(),
        |at| sensor_temperature(&at, sensor);

    /// What the formula of an entry of `derived_outputs` gives.
    Derived { derived } =
        Row::state(Of::Derived, "NAME", "-", "Derived output"),
        |at| derived_output(&at, derived);
}

/// The value of a derived output from those of the outputs that its formula uses.
// Outputs are read by outputs: no inlining.
#[inline(never)]
fn derived_output<S: Real>(at: &At<'_, S>, derived: usize) -> S {
    let mut quantities = [S::zero(); MOST];
    let of = &at.plan.description.outputs[derived].of;
    for (quantity, used) in quantities.iter_mut().zip(of) {
        if let Some(output) = Output::at(&used.kind, &used.place) {
            *quantity = output.read(at.plan, at.step, at.state);
        }
    }
    at.step.model.coefficients.outputs[derived].value(&quantities[..of.len()])
}

impl Output {
    /// Checks that the zone, wall, layer or sensor exists.
    ///
    /// # Errors
    /// [`EngineError::Input`].
    pub fn check(&self, plan: &Plan) -> Result<(), EngineError> {
        require(self.row().of, plan, &self.place(), self)?;
        let Self::Derived { derived } = *self else { return Ok(()) };
        for used in &plan.description.outputs[derived].of {
            let output = Self::at(&used.kind, &used.place).ok_or_else(|| {
                EngineError::Input(format!(
                    "{}: found the kind '{}', expected one of the table",
                    used.name, used.kind
                ))
            })?;
            output.check(plan)?;
        }
        Ok(())
    }

    /// The part of the building that it is read at, for messages.
    pub(crate) fn part(&self, plan: &Plan) -> String {
        self.row().of.part(plan, &self.place())
    }

    /// Whether it is a mean over the step of the sun that surfaces absorb, or of its beam, which are averaged on request only.
    #[must_use]
    pub fn averages_absorbed_sun(&self) -> bool {
        matches!(
            self,
            Self::AbsorbedSolar { .. }
                | Self::IncidentBeam { .. }
                | Self::IncidentDiffuse { .. }
                | Self::Derived { .. }
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every kind of the table is read from JSON, with the positions that its name has.
    #[test]
    fn rows_are_outputs() {
        let positions = |of: Of| match of {
            Of::Side | Of::SunlitSide | Of::RadiatingSide | Of::ConvectiveSide | Of::HumidSide => {
                r#", "surface": 0, "side": 1"#
            }
            Of::OutdoorSurface | Of::Window | Of::OutdoorWindow => r#", "surface": 0"#,
            Of::Interface => r#", "surface": 0, "interface": 1"#,
            Of::Layer | Of::MeltingLayer => r#", "surface": 0, "layer": 0"#,
            Of::Vent => r#", "vent": 0"#,
            Of::Control => r#", "control": 0"#,
            Of::Source | Of::WaterSource => r#", "source": 0"#,
            Of::Building => "",
            Of::Sensor => r#", "sensor": 0"#,
            Of::Derived => r#", "derived": 0"#,
            _ => r#", "zone": 0"#,
        };
        let table = Output::table();
        for entry in &table {
            let text = format!(r#"{{"kind": "{}"{}}}"#, entry.kind, positions(entry.row.of));
            let output: Output = serde_json::from_str(&text).expect(&text);
            assert_eq!(*output.row(), entry.row);
            assert_eq!(Output::at(&entry.kind, &output.place()), Some(output));
        }
        assert_eq!(table[1].kind, "mean_radiant_temperature");
        assert_eq!(table[0].meaning, "Temperature of the air");
    }
}
