//! Lists the published laws: each file of a folder of [`FAMILIES`] is one, and its name is the kind of the law in a description.

use std::env::var;
use std::fmt::Write;
use std::fs::{read_dir, write};
use std::path::{Path, PathBuf};

/// What there are laws of, and the folder of these laws.
const FAMILIES: [(&str, &str); 6] = [
    ("convection", "src/physics/convection/laws"),
    ("sky", "src/physics/longwave/skies"),
    ("diffuse", "src/physics/diffuse/laws"),
    ("leakage", "src/physics/leakage/laws"),
    ("sorption", "src/physics/sorption/laws"),
    ("imposed", "src/physics/imposed/laws"),
];

fn main() {
    let root = PathBuf::from(var("CARGO_MANIFEST_DIR").expect("Cargo sets CARGO_MANIFEST_DIR"));
    let out = PathBuf::from(var("OUT_DIR").expect("Cargo sets OUT_DIR"));
    println!("cargo::rerun-if-changed=build.rs");
    for (family, folder) in FAMILIES {
        let folder = root.join(folder);
        println!("cargo::rerun-if-changed={}", folder.display());
        write(out.join(format!("{family}_laws.rs")), list(&folder)).expect("OUT_DIR can be written");
    }
}

/// Modules, and a macro that passes module, type and kind of each law to another one.
fn list(folder: &Path) -> String {
    let entries = read_dir(folder).expect("the folder of the laws can be read");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a file of the folder").path()).collect();
    files.retain(|file| file.extension().is_some_and(|end| end == "rs") && !file.ends_with("mod.rs"));
    files.sort();
    let (mut modules, mut rows) = (String::new(), String::new());
    for file in files {
        let kind = file.file_stem().and_then(|stem| stem.to_str()).expect("a name in ASCII");
        let _ = writeln!(modules, "#[path = {:?}]\npub(crate) mod {kind};", file.display().to_string());
        let _ = write!(rows, "({kind}, {}, {kind:?}) ", type_of(kind));
    }
    format!(
        "{modules}\nmacro_rules! with_laws {{ ($receiver:ident) => {{ $receiver! {{ {rows} }} }}; }}\n\
         pub(crate) use with_laws;\n"
    )
}

/// `AlamdariHammond` of `alamdari_hammond`.
fn type_of(kind: &str) -> String {
    kind.split('_').map(|word| word[..1].to_uppercase() + &word[1..]).collect()
}
