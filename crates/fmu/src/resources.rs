//! The folder `resources` of a unit.

use std::fs;
use std::path::Path;

use mascarin_contents::Contents;

/// Reads the folder.
///
/// # Errors
/// A file is missing, damaged or of another version; the text names it.
pub fn read(folder: &Path) -> Result<Contents, String> {
    let bytes = |name: &str| {
        let file = folder.join(name);
        fs::read(&file).map_err(|error| format!("{}: cannot be read: {error}", file.display()))
    };
    let wrong = |(name, reason): (&str, String)| {
        format!("{}: {reason}. Export the unit again", folder.join(name).display())
    };
    let text = |name: &'static str| {
        String::from_utf8(bytes(name)?).map_err(|error| wrong((name, format!("is damaged: {error}"))))
    };
    Contents::read(&text("run.json")?, &text("building.json")?, &bytes("forcing.bin")?).map_err(wrong)
}
