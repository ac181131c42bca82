//! A building with its weather, run with other values.

use mascarin_contents::{Contents, Role};
use mascarin_engine::RunControl;
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::run::physical_limits::Outlier;
use mascarin_engine::run::{Run, simulate};
use mascarin_engine::vapour::VapourFlow;
use serde_json::{Map, Value, json};

/// A building that was read, its values, and what its last run gave.
pub struct Model {
    contents: Contents,
    values: Vec<f64>,
    records: Vec<f64>,
    findings: String,
}

impl Model {
    /// Reads `run.json`, `building.json` and `forcing.bin`.
    ///
    /// # Errors
    /// A file is damaged or of another version; the text names it.
    pub fn read(files: &[Vec<u8>; 3]) -> Result<Self, String> {
        let [run, building, forcing] = files;
        let text =
            |name, bytes| core::str::from_utf8(bytes).map_err(|error| format!("{name}: is damaged: {error}"));
        let (run, building) = (text("run.json", run)?, text("building.json", building)?);
        let contents = Contents::read(run, building, forcing)
            .map_err(|(name, reason)| format!("{name}: {reason}. Make the page again"))?;
        let values = contents.parameters.clone();
        Ok(Self { contents, values, records: Vec::new(), findings: String::new() })
    }

    /// Back to the values of the building.
    pub fn reset(&mut self) {
        self.values.clone_from(&self.contents.parameters);
    }

    /// Sets a number of the parameter vector, which must be a variable of the page.
    ///
    /// # Errors
    /// It is not, or the value is outside of its limits.
    pub fn set(&mut self, position: usize, value: f64) -> Result<(), String> {
        let mut variables = self.contents.variables.iter();
        let variable = variables
            .find(|variable| matches!(variable.role, Role::Parameter(own) if own == position))
            .ok_or_else(|| format!("parameter {position}: the page has no slider for it"))?;
        let (low, high) = (variable.low.unwrap_or(f64::NEG_INFINITY), variable.high.unwrap_or(f64::INFINITY));
        if !(value.is_finite() && low <= value && value <= high) {
            let (name, unit) = (&variable.name, &variable.unit);
            return Err(format!("{name}: found {value} {unit}, expected {low} to {high} {unit}"));
        }
        self.values[position] = value;
        Ok(())
    }

    /// Runs the building over all its weather.
    ///
    /// # Errors
    /// Set points that cross, a step that does not converge or leads to what is impossible; the text says where.
    pub fn run(&mut self) -> Result<(), String> {
        self.contents.require_set_points_apart(&self.values)?;
        let contents = &self.contents;
        let forcing = contents.forcing(contents.rows(0, contents.steps()))?;
        let control = RunControl::default();
        let run = simulate(&contents.plan, &self.values, &forcing, &contents.options, &control)
            .map_err(|error| error.to_string())?;
        self.findings = findings(&run).to_string();
        self.records = run.records;
        Ok(())
    }

    /// Records of the last run, rows x records.
    #[must_use]
    pub fn records(&self) -> &[f64] {
        &self.records
    }

    /// Balances of the last run, and what was noticed in it, as JSON.
    #[must_use]
    pub fn findings(&self) -> &str {
        &self.findings
    }
}

/// As the binding gives them to Python.
fn findings(run: &Run<f64>) -> Value {
    let balance = &run.energy_balance;
    let into: Map<String, Value> =
        Flow::ALL.iter().map(|&flow| (flow.name().to_owned(), json!(balance.into[flow as usize]))).collect();
    let vapour = &balance.vapour;
    let outlier = run.outlier.as_ref().map(|Outlier { step, place, temperature, bound }| {
        json!({ "step": step, "place": place, "temperature": temperature, "bound": bound })
    });
    let beyond: Vec<Value> = run
        .out_of_range
        .iter()
        .map(|law| json!({ "place": law.place, "law": law.law, "steps": law.steps, "first": law.first }))
        .collect();
    json!({
        "into": into,
        "stored": balance.stored,
        "closure": balance.closure(),
        "vapour": {
            "condensed": -vapour.into[VapourFlow::Condensation as usize],
            "exchanged": vapour.total_exchanged,
            "closure": vapour.closure(),
            "corrected": vapour.corrected,
        },
        "outlier": outlier,
        "out_of_range": beyond,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(run: &[u8], building: &[u8], forcing: &[u8]) -> String {
        match Model::read(&[run.to_vec(), building.to_vec(), forcing.to_vec()]) {
            Ok(_) => String::new(),
            Err(text) => text,
        }
    }

    /// Pages with whole files are run in a browser (`tests/unit/pages/test_live_page.py`).
    #[test]
    fn damaged_files_are_named() {
        assert!(
            refusal(b"{\"format\": 1}", b"{}", b"")
                .starts_with("run.json: is damaged: it does not have format")
        );
        assert!(refusal(b"{", b"{}", b"").starts_with("run.json: is damaged"));
        assert!(refusal(&[0xff], b"{}", b"").starts_with("run.json: is damaged: invalid utf-8"));
        assert!(refusal(b"{}", &[0xff], b"").starts_with("building.json: is damaged"));
    }
}
