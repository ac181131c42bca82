//! States of a unit, which an importing program keeps and comes back to, also as bytes in a file.

use crate::unit::Mode;
use mascarin_contents::Contents;

/// First bytes of a state in a file, with the number of its format.
const MAGIC: &[u8; 8] = b"MASCST01";

/// All that a unit goes on from.
#[derive(Debug, Clone, PartialEq)]
pub struct Saved {
    pub(crate) mode: Mode,
    /// Step of the weather that the run started at.
    pub(crate) first: usize,
    pub(crate) parameters: Vec<f64>,
    pub(crate) inputs: Vec<f64>,
    pub(crate) outputs: Vec<f64>,
    /// What the engine goes on from; empty before the start.
    pub(crate) run: Vec<f64>,
}

impl Saved {
    /// The state as bytes.
    #[must_use]
    pub fn to_bytes(&self, contents: &Contents) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        let mut write = |number: u64| bytes.extend(number.to_le_bytes());
        write(fingerprint(&contents.token));
        write(self.mode as u64);
        write(self.first as u64);
        for values in [&self.parameters, &self.inputs, &self.outputs, &self.run] {
            write(values.len() as u64);
            for value in values {
                write(value.to_bits());
            }
        }
        bytes
    }

    /// Reads the bytes that a unit of the same contents wrote.
    ///
    /// # Errors
    /// They are not such bytes.
    pub fn from_bytes(contents: &Contents, bytes: &[u8]) -> Result<Self, String> {
        Self::read(contents, bytes).ok_or_else(|| {
            format!("the state ({} bytes) was not saved by this unit; save it again", bytes.len())
        })
    }

    fn read(contents: &Contents, bytes: &[u8]) -> Option<Self> {
        let (words, rest) = bytes.strip_prefix(MAGIC)?.as_chunks::<8>();
        let mut words = words.iter().map(|word| u64::from_le_bytes(*word));
        if words.next()? != fingerprint(&contents.token) || !rest.is_empty() {
            return None;
        }
        let mode = Mode::of(words.next()?)?;
        let first = usize::try_from(words.next()?).ok().filter(|&first| first < contents.steps())?;
        let mut list = || {
            let count = usize::try_from(words.next()?).ok()?;
            let values: Vec<f64> = words.by_ref().take(count).map(f64::from_bits).collect();
            (values.len() == count).then_some(values)
        };
        let (parameters, inputs, outputs, run) = (list()?, list()?, list()?, list()?);
        words.next().is_none().then_some(Self { mode, first, parameters, inputs, outputs, run })
    }
}

/// A number that differs from unit to unit: FNV-1a (Fowler, Noll & Vo).
fn fingerprint(token: &str) -> u64 {
    token.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}
