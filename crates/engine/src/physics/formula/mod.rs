//! Laws written as text: a formula is read once, and computed with any kind of number.
//!
//! | file | contents |
//! |---|---|
//! | [`lexer`] | the words of a formula, each with its line and column |
//! | [`parser`] | the tree of a formula, with the place of each operation; errors say what to write |
//! | [`tree`] | that tree, and its plain value as written: not a number where a root or a quotient has none |
//! | [`units`] | whether the units of its numbers fit together |
//! | [`graph`] | the same as a graph without repeated parts: constants folded, powers simplified, derivatives |
//! | `derivative` | derivatives by the variable, powers as roots and products |
//! | [`reading`] | from the tree to the graph |
//! | [`expression`] | outputs that are derived from others |
//! | [`function`] | laws of a few names as text: conductivity, infiltration, sky |
//! | [`function_check`] | whether they are laws |
//! | [`program`] | the graph as short instructions for a few registers, computed over [`Real`](crate::number::real::Real) |
//!
//! A quantity that uses formulas says which names it has and what is computed when ([`Level`](graph::Level)): what depends on numbers of
//! the description only is computed once per run, what depends on the wind once per stage.

pub(crate) mod derivative;
pub(crate) mod expression;
pub(crate) mod function;
pub(crate) mod function_check;
pub(crate) mod graph;
pub(crate) mod lexer;
pub(crate) mod parser;
pub(crate) mod program;
pub(crate) mod reading;
#[cfg(test)]
mod tests;
pub(crate) mod tree;
pub(crate) mod units;

/// With more numbers that have ranges not all ends of them are combined.
const COMBINED: usize = 4;

/// Values of numbers at the ends of their ranges: all combinations of few, of many each alone and all together.
pub(crate) fn corners(numbers: &[LawNumber]) -> Vec<Vec<f64>> {
    let ranges: Vec<(usize, [f64; 2])> = (numbers.iter().enumerate())
        .filter_map(|(place, number)| number.range.map(|range| (place, range)))
        .collect();
    let with = |chosen: &dyn Fn(usize) -> Option<usize>| {
        let mut values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        for (k, (place, range)) in ranges.iter().enumerate() {
            if let Some(end) = chosen(k) {
                values[*place] = range[end];
            }
        }
        values
    };
    let count = ranges.len();
    if count == 0 {
        return Vec::new();
    }
    if count <= COMBINED {
        return (0..1usize << count).map(|bits| with(&|k| Some(bits >> k & 1))).collect();
    }
    let alone = (0..count).flat_map(|k| [0, 1].map(|end| with(&|other| (other == k).then_some(end))));
    alone.chain([0, 1].map(|end| with(&|_| Some(end)))).collect()
}

/// Where a part of a formula is: line and column, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line of the text.
    pub line: u32,
    /// Character of the line.
    pub column: u32,
}

/// What is wrong with a formula, where, and what to do.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Where it is.
    pub at: Position,
    /// What stands there.
    pub found: String,
    /// What may stand there.
    pub expected: String,
    /// What to write.
    pub remedy: String,
}

/// Which text of a law a fault is in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormulaFault {
    /// `formula`, `valid`, or the name of a number.
    pub key: String,
    /// What is wrong.
    pub fault: Fault,
}

/// A number of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawNumber {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Lowest and highest value.
    pub range: Option<[f64; 2]>,
    /// Its unit; none: not stated.
    pub unit: Option<String>,
}

impl core::fmt::Display for Fault {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { at: Position { line, column }, found, expected, remedy } = self;
        if *line > 1 {
            write!(f, "line {line}, ")?;
        }
        write!(f, "column {column}: found {found}, expected {expected}. {remedy}")
    }
}
