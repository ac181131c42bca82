//! A file that travels packed inside of a program.
//!
//! A build script cannot pack the library of an FMU for the crate that contains it: it runs before Cargo has built the library. A macro is
//! expanded when the crate itself is compiled, after all of its dependencies.

use std::io::Write;

use lzma_rust2::{LzmaOptions, LzmaWriter};
use proc_macro::{Literal, TokenStream, TokenTree};

/// The best of the presets 0 to 9; a megabyte takes about a second.
const PRESET: u32 = 9;

/// `packed_file!(VARIABLE)`: the bytes, packed as LZMA (`.lzma`), of the file that an environment variable of the build names.
///
/// The file is also named by `include_bytes!`, in a constant that nobody uses: the compiler then knows that the crate depends on it,
/// and the program does not contain it a second time.
#[proc_macro]
pub fn packed_file(variable: TokenStream) -> TokenStream {
    let packed = named(&variable).and_then(|path| {
        let content = std::fs::read(&path).map_err(|error| format!("{path}: {error}"))?;
        Ok((path, pack(&content).map_err(|error| format!("cannot pack: {error}"))?))
    });
    match packed {
        Ok((path, bytes)) => {
            let path = TokenTree::from(Literal::string(&path));
            let bytes = TokenTree::from(Literal::byte_string(&bytes));
            code("{ const _: &[u8] = include_bytes!(PATH); BYTES }", &[("PATH", path), ("BYTES", bytes)])
        }
        Err(found) => {
            let text = format!("packed_file!({variable}): {found}");
            code("compile_error!(TEXT)", &[("TEXT", TokenTree::from(Literal::string(&text)))])
        }
    }
}

/// The path that an environment variable of the build gives.
fn named(variable: &TokenStream) -> Result<String, String> {
    let name = variable.to_string();
    std::env::var(&name)
        .map_err(|error| format!("{error}; expected a variable that the build script sets to a path"))
}

fn pack(content: &[u8]) -> std::io::Result<Vec<u8>> {
    let size = Some(content.len() as u64);
    let mut writer = LzmaWriter::new_use_header(Vec::new(), &LzmaOptions::with_preset(PRESET), size)?;
    writer.write_all(content)?;
    writer.finish()
}

/// Rust code in which some words are replaced.
fn code(text: &str, words: &[(&str, TokenTree)]) -> TokenStream {
    let tokens: TokenStream = text.parse().expect("Rust code");
    replaced(tokens, words)
}

fn replaced(tokens: TokenStream, words: &[(&str, TokenTree)]) -> TokenStream {
    let one = |token: TokenTree| match token {
        TokenTree::Group(group) => {
            let inside = replaced(group.stream(), words);
            TokenTree::from(proc_macro::Group::new(group.delimiter(), inside))
        }
        TokenTree::Ident(word) => {
            let text = word.to_string();
            let found = words.iter().find(|(name, _)| *name == text);
            found.map_or(TokenTree::Ident(word), |(_, token)| token.clone())
        }
        other => other,
    };
    tokens.into_iter().map(one).collect()
}
