//! Parts of a graph as short instructions for a few registers, computed over [`Real`].
//!
//! An operand is a register, or a number that was computed before. An instruction is six bytes; reading it costs little beside a
//! root or an exponential of eight surfaces at once.

use std::collections::HashMap;

use super::graph::{Graph, Id, Node};
use crate::number::real::Real;

/// Registers of a program; what needs more is refused.
const REGISTERS: usize = 32;
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
            let to = u8::try_from(to).map_err(|_| TooLong)?;
            computed.insert(id, to);
            code.push(Instruction { code: code_of(graph.node(id)), to, of });
        }
        Ok(Self { code, results: parts.iter().map(|part| computed[part]).collect() })
    }

    /// How many results it has.
    pub(crate) fn results(&self) -> usize {
        self.results.len()
    }

    /// The registers after the instructions; `number`: those that were computed before.
    #[inline(always)]
    fn registers<V: Real>(&self, inputs: &[V], number: &impl Fn(usize) -> V) -> [V; REGISTERS] {
        let mut registers = [V::zero(); REGISTERS];
        registers[..inputs.len()].copy_from_slice(inputs);
        for Instruction { code, to, of } in &self.code {
            macro_rules! get {
                ($k:literal) => {
                    operand(of[$k], &registers, number)
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
            registers[*to as usize % REGISTERS] = value;
        }
        registers
    }

    /// A fixed number of results.
    #[inline(always)]
    pub(crate) fn compute<V: Real, const N: usize>(
        &self,
        inputs: &[V],
        number: impl Fn(usize) -> V,
    ) -> [V; N] {
        let registers = self.registers(inputs, &number);
        core::array::from_fn(
            #[inline(always)]
            |k| operand(self.results[k], &registers, &number),
        )
    }

    /// All results.
    // One copy only: it is used once per run.
    #[inline(never)]
    pub(crate) fn compute_all<S: Real>(&self, inputs: &[S], numbers: &[S]) -> Vec<S> {
        let number = |place: usize| numbers[place];
        let registers = self.registers(inputs, &number);
        self.results.iter().map(|&result| operand(result, &registers, &number)).collect()
    }
}

#[inline(always)]
fn operand<V: Real>(place: u8, registers: &[V; REGISTERS], number: &impl Fn(usize) -> V) -> V {
    if place < NUMBERS { registers[place as usize % REGISTERS] } else { number((place - NUMBERS) as usize) }
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
