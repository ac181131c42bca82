//! Parts of a graph as short instructions for a few registers, computed over [`Real`].
//!
//! An operand is a register, or a number that was computed before. An instruction is six bytes; reading it costs little beside a
//! root or an exponential of eight surfaces at once.

use std::collections::HashMap;

use super::graph::{Graph, Id, Node};
use crate::number::real::Real;

/// Registers of a program; what needs more is refused.
const REGISTERS: usize = 32;
/// Registers of the usual program.
const FEW: usize = 8;
/// Operands from this on are numbers that were computed before.
const NUMBERS: u8 = 32;
/// How many numbers there may be.
const MOST_NUMBERS: usize = 200;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Code {
    Plus,
    Minus,
    Times,
    Over,
    Negative,
    Sqrt,
    InverseCbrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Min,
    Max,
    Choose,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Instruction {
    code: Code,
    to: u8,
    of: [u8; 4],
}

/// Instructions that compute some parts of a graph.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Program {
    code: Vec<Instruction>,
    results: Vec<u8>,
    /// How many registers are used.
    registers: usize,
}

/// A formula that needs more registers or numbers than there are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TooLong;

impl Program {
    /// A program for parts of a graph; `inputs`: those in the first registers; `numbers`: those that were computed before.
    pub(crate) fn new(graph: &Graph, parts: &[Id], inputs: &[Id], numbers: &[Id]) -> Result<Self, TooLong> {
        let mut order = Vec::new();
        let mut computed: HashMap<Id, u8> = HashMap::new();
        if numbers.len() > MOST_NUMBERS || inputs.len() > REGISTERS {
            return Err(TooLong);
        }
        for (place, &id) in numbers.iter().enumerate() {
            computed.insert(id, NUMBERS + u8::try_from(place).map_err(|_| TooLong)?);
        }
        for (place, &id) in inputs.iter().enumerate() {
            computed.insert(id, u8::try_from(place).map_err(|_| TooLong)?);
        }
        for &part in parts {
            list(graph, part, &computed, &mut order);
        }
        let mut last: HashMap<Id, usize> = HashMap::new();
        for (place, &id) in order.iter().enumerate() {
            for operand in graph.operands(id) {
                last.insert(operand, place);
            }
        }
        for &part in parts {
            last.insert(part, usize::MAX);
        }
        let mut free = [true; REGISTERS];
        for &id in inputs {
            free[computed[&id] as usize] = !last.contains_key(&id);
        }
        let mut code = Vec::with_capacity(order.len());
        let mut registers = inputs.len();
        for (place, &id) in order.iter().enumerate() {
            let operands = graph.operands(id);
            let mut of = [0; 4];
            for (slot, operand) in of.iter_mut().zip(&operands) {
                *slot = computed[operand];
            }
            for operand in &operands {
                let register = computed[operand];
                if register < NUMBERS && last[operand] == place {
                    free[register as usize] = true;
                }
            }
            let to = free.iter().position(|free| *free).ok_or(TooLong)?;
            free[to] = false;
            registers = registers.max(to + 1);
            let to = u8::try_from(to).map_err(|_| TooLong)?;
            computed.insert(id, to);
            code.push(Instruction { code: code_of(graph.node(id)), to, of });
        }
        Ok(Self { code, results: parts.iter().map(|part| computed[part]).collect(), registers })
    }

    /// How many results it has.
    pub(crate) fn results(&self) -> usize {
        self.results.len()
    }

    /// Does all instructions.
    #[inline(always)]
    fn fill<V: Real, const SIZE: usize>(&self, registers: &mut [V; SIZE], number: &impl Fn(usize) -> V) {
        for Instruction { code, to, of } in &self.code {
            macro_rules! get {
                ($k:literal) => {
                    operand(of[$k], registers, number)
                };
            }
            let value = match code {
                Code::Plus => get!(0) + get!(1),
                Code::Minus => get!(0) - get!(1),
                Code::Times => get!(0) * get!(1),
                Code::Over => get!(0) / get!(1),
                Code::Negative => -get!(0),
                Code::Sqrt => get!(0).sqrt(),
                Code::InverseCbrt => get!(0).inverse_cbrt(),
                Code::Exp => get!(0).exp(),
                Code::Ln => get!(0).ln(),
                Code::Sin => get!(0).sin(),
                Code::Cos => get!(0).cos(),
                Code::Min => get!(0).min(get!(1)),
                Code::Max => get!(0).max(get!(1)),
                Code::Choose => V::select(get!(0).lt(get!(1)), get!(2), get!(3)),
            };
            registers[*to as usize % SIZE] = value;
        }
    }

    #[inline(always)]
    fn execute<V: Real, const SIZE: usize, const N: usize>(
        &self,
        inputs: &[V],
        number: &impl Fn(usize) -> V,
    ) -> [V; N] {
        let mut registers = [V::zero(); SIZE];
        registers[..inputs.len()].copy_from_slice(inputs);
        self.fill(&mut registers, number);
        let mut results = [V::zero(); N];
        for (result, &place) in results.iter_mut().zip(&self.results) {
            *result = operand(place, &registers, number);
        }
        results
    }

    /// A fixed number of results, at most as many as it has.
    #[inline(always)]
    pub(crate) fn compute<V: Real, const N: usize>(
        &self,
        inputs: &[V],
        number: impl Fn(usize) -> V,
    ) -> [V; N] {
        // Setting registers to zero takes as long as some instructions.
        if self.registers <= FEW {
            self.execute::<V, FEW, N>(inputs, &number)
        } else {
            self.execute::<V, REGISTERS, N>(inputs, &number)
        }
    }

    /// All results of a program without inputs.
    // One copy only: it is used once per run.
    #[inline(never)]
    pub(crate) fn compute_all<S: Real>(&self, numbers: &[S]) -> Vec<S> {
        let number = |place: usize| numbers[place];
        let mut registers = [S::zero(); REGISTERS];
        self.fill(&mut registers, &number);
        self.results.iter().map(|&result| operand(result, &registers, &number)).collect()
    }
}

#[inline(always)]
fn operand<V: Real, const SIZE: usize>(place: u8, registers: &[V; SIZE], number: &impl Fn(usize) -> V) -> V {
    if place < NUMBERS { registers[place as usize % SIZE] } else { number((place - NUMBERS) as usize) }
}

/// Parts in an order in which each comes after what it is made of.
fn list(graph: &Graph, id: Id, computed: &HashMap<Id, u8>, order: &mut Vec<Id>) {
    if computed.contains_key(&id) || order.contains(&id) {
        return;
    }
    for operand in graph.operands(id) {
        list(graph, operand, computed, order);
    }
    order.push(id);
}

fn code_of(node: Node) -> Code {
    match node {
        Node::Plus(..) => Code::Plus,
        Node::Minus(..) => Code::Minus,
        Node::Times(..) | Node::Power(..) => Code::Times,
        Node::Over(..) => Code::Over,
        // Constants and inputs are never computed: they are numbers, or in registers.
        Node::Negative(_) | Node::Constant(_) | Node::Input(_) => Code::Negative,
        Node::Sqrt(_) => Code::Sqrt,
        Node::InverseCbrt(_) => Code::InverseCbrt,
        Node::Exp(_) => Code::Exp,
        Node::Ln(_) => Code::Ln,
        Node::Sin(_) => Code::Sin,
        Node::Cos(_) => Code::Cos,
        Node::Min(..) => Code::Min,
        Node::Max(..) => Code::Max,
        Node::Choose { .. } => Code::Choose,
    }
}
