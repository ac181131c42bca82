//! From the words of a formula to its tree, by recursive descent.
//!
//! ```text
//! condition  = both {"or" both};  both = holds {"and" holds};  holds = "not" holds | comparison | "(" condition ")"
//! comparison = sum ("<" | "<=" | ">" | ">=") sum {... sum}
//! sum        = product {("+" | "-") product};  product = signed {("*" | "/") signed}
//! signed     = "-" signed | power;  power = atom ["^" signed]
//! atom       = number | name | function "(" sum {"," sum} ")" | "if" "(" condition "," sum "," sum ")" | "(" sum ")"
//! ```

use super::lexer::{Token, Word, fault, words};
use super::tree::{Condition, FUNCTIONS, Function, Kind, Operation, Tree};
use super::{Fault, Position};

/// Brackets and signs inside each other, so that no text exhausts the stack.
const DEEPEST: usize = 60;
const COMPARISONS: [&str; 4] = ["<", "<=", ">", ">="];
/// Names that are signs or constants.
const RESERVED: [&str; 5] = ["if", "and", "or", "not", "pi"];

/// What the names of a formula stand for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Names<'a> {
    /// Names that may be used, by their places.
    pub(crate) usable: &'a [&'a str],
    /// Names of those that are one or zero, which are conditions.
    pub(crate) flags: &'a [&'a str],
    /// Names that exist elsewhere, and why not here.
    pub(crate) absent: &'a [(&'a str, &'a str)],
}

/// Whether a word has a meaning in every formula, so that no number can have it as its name.
pub(crate) fn reserved(name: &str) -> bool {
    RESERVED.contains(&name) || FUNCTIONS.iter().any(|(known, _)| *known == name)
}

/// Reads a formula that is a number.
///
/// # Errors
/// The first fault of the text.
pub(crate) fn number(text: &str, names: Names<'_>) -> Result<Tree, Fault> {
    let mut parser = Parser::new(text, names)?;
    let tree = parser.sum()?;
    if let Word::Sign(sign) = parser.word()
        && COMPARISONS.contains(sign)
    {
        let remedy = "Write if(a < b, x, y) for a value that depends on a comparison.";
        return Err(fault(parser.at(), parser.word().shown(), "a number, not a comparison", remedy));
    }
    parser.end()?;
    Ok(tree)
}

/// Reads a formula that holds or not.
///
/// # Errors
/// The first fault of the text.
pub(crate) fn condition(text: &str, names: Names<'_>) -> Result<Condition, Fault> {
    let mut parser = Parser::new(text, names)?;
    let condition = parser.condition()?;
    parser.end()?;
    Ok(condition)
}

/// A place in the words of a formula.
#[derive(Debug)]
pub(super) struct Parser<'a> {
    tokens: Vec<Token>,
    place: usize,
    depth: usize,
    names: Names<'a>,
}

impl<'a> Parser<'a> {
    pub(super) fn new(text: &str, names: Names<'a>) -> Result<Self, Fault> {
        let tokens = words(text)?;
        if tokens.len() == 1 {
            return Err(fault(tokens[0].at, "nothing", "a formula", "Write one, such as 2.3*abs(dT)^0.24."));
        }
        Ok(Self { tokens, place: 0, depth: 0, names })
    }

    pub(super) fn word(&self) -> &Word {
        &self.tokens[self.place].word
    }

    pub(super) fn at(&self) -> Position {
        self.tokens[self.place].at
    }

    pub(super) fn advance(&mut self) {
        self.place = (self.place + 1).min(self.tokens.len() - 1);
    }

    pub(super) fn take(&mut self, sign: &str) -> bool {
        let found = matches!(self.word(), Word::Sign(word) if *word == sign);
        if found {
            self.advance();
        }
        found
    }

    fn take_name(&mut self, name: &str) -> bool {
        let found = matches!(self.word(), Word::Name(word) if word == name);
        if found {
            self.advance();
        }
        found
    }

    /// Begins something inside of something.
    pub(super) fn deeper(&mut self) -> Result<(), Fault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            let expected = format!("at most {DEEPEST} inside each other");
            return Err(fault(self.at(), "brackets and signs that are too deep", &expected, "Simplify it."));
        }
        Ok(())
    }

    pub(super) fn close(&mut self, opened: Position) -> Result<(), Fault> {
        if self.take(")") {
            return Ok(());
        }
        let comma = matches!(self.word(), Word::Sign(","));
        let remedy = if comma {
            "Write decimals with a point, as in 0.33; a comma separates the arguments of min, max and if."
                .into()
        } else {
            format!("Close the bracket of column {}.", opened.column)
        };
        Err(fault(self.at(), self.word().shown(), "')'", &remedy))
    }

    fn end(&self) -> Result<(), Fault> {
        let remedy = match self.word() {
            Word::End => return Ok(()),
            Word::Sign(")") => "Remove this bracket, or open one.",
            Word::Sign(",") => "Write decimals with a point, as in 0.33.",
            Word::Number(_) | Word::Name(_) | Word::Sign("(") => "Write * for a product.",
            Word::Sign(_) => "Check the signs.",
        };
        Err(fault(self.at(), self.word().shown(), "a sign or the end of the formula", remedy))
    }

    fn condition(&mut self) -> Result<Condition, Fault> {
        let mut first = self.both()?;
        while self.take_name("or") {
            first = Condition::Either(Box::new([first, self.both()?]));
        }
        Ok(first)
    }

    fn both(&mut self) -> Result<Condition, Fault> {
        let mut first = self.holds()?;
        while self.take_name("and") {
            first = Condition::Both(Box::new([first, self.holds()?]));
        }
        Ok(first)
    }

    fn holds(&mut self) -> Result<Condition, Fault> {
        self.deeper()?;
        let condition = if self.take_name("not") {
            Condition::Not(Box::new(self.holds()?))
        } else if self.opens_condition() {
            let opened = self.at();
            self.advance();
            let inside = self.condition()?;
            self.close(opened)?;
            inside
        } else {
            self.comparison()?
        };
        self.depth -= 1;
        Ok(condition)
    }

    /// Whether the bracket at this place encloses a condition: a comparison or a word of conditions stands in it.
    fn opens_condition(&self) -> bool {
        if !matches!(self.word(), Word::Sign("(")) {
            return false;
        }
        // Whether each open bracket encloses the arguments of a function.
        let mut open: Vec<bool> = Vec::new();
        for (place, token) in self.tokens.iter().enumerate().skip(self.place) {
            let plain = open.iter().all(|of_function| !of_function);
            match &token.word {
                Word::Sign("(") => {
                    let before = place.checked_sub(1).map(|place| &self.tokens[place].word);
                    open.push(
                        place > self.place && matches!(before, Some(Word::Name(name)) if reserved(name)),
                    );
                }
                Word::Sign(")") => {
                    open.pop();
                    if open.is_empty() {
                        return false;
                    }
                }
                Word::Sign(sign) if plain && COMPARISONS.contains(sign) => return true,
                Word::Name(name) if plain && ["and", "or", "not"].contains(&name.as_str()) => return true,
                _ => {}
            }
        }
        false
    }

    /// `a < b`, or a chain such as `-30 < dT < 30`.
    fn comparison(&mut self) -> Result<Condition, Fault> {
        let mut first = self.sum()?;
        let mut found: Option<Condition> = None;
        while let Word::Sign(sign) = *self.word()
            && COMPARISONS.contains(&sign)
        {
            self.advance();
            let second = self.sum()?;
            let (low, high) = if sign.starts_with('<') { (&first, &second) } else { (&second, &first) };
            let holds = if sign.ends_with('=') {
                let above = Condition::Less(Box::new([high.clone(), low.clone()]));
                Condition::Not(Box::new(above))
            } else {
                Condition::Less(Box::new([low.clone(), high.clone()]))
            };
            found = Some(match found {
                Some(before) => Condition::Both(Box::new([before, holds])),
                None => holds,
            });
            first = second;
        }
        if let Some(found) = found {
            return Ok(found);
        }
        if let Kind::Name(index) = first.kind
            && self.names.flags.contains(&self.names.usable[index])
        {
            return Ok(Condition::Flag(Box::new(first)));
        }
        Err(fault(first.at, "a number", "a comparison", "Compare it, such as abs(dT) < 30."))
    }

    fn sum(&mut self) -> Result<Tree, Fault> {
        self.chain(Self::product, [("+", Operation::Plus), ("-", Operation::Minus)])
    }

    fn product(&mut self) -> Result<Tree, Fault> {
        self.chain(Self::signed, [("*", Operation::Times), ("/", Operation::Over)])
    }

    fn chain(
        &mut self,
        part: fn(&mut Self) -> Result<Tree, Fault>,
        operations: [(&str, Operation); 2],
    ) -> Result<Tree, Fault> {
        let mut first = part(self)?;
        loop {
            let at = self.at();
            let Some(&(_, operation)) = operations.iter().find(|(sign, _)| self.take(sign)) else {
                return Ok(first);
            };
            let second = part(self)?;
            first = Tree { at, kind: Kind::Binary(operation, Box::new([first, second])) };
        }
    }

    pub(super) fn signed(&mut self) -> Result<Tree, Fault> {
        self.deeper()?;
        let at = self.at();
        let tree = if self.take("-") {
            Tree { at, kind: Kind::Negative(Box::new(self.signed()?)) }
        } else if self.take("+") {
            self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(tree)
    }

    fn power(&mut self) -> Result<Tree, Fault> {
        let base = self.atom()?;
        let at = self.at();
        if self.take("^") {
            let exponent = self.signed()?;
            return Ok(Tree { at, kind: Kind::Binary(Operation::Power, Box::new([base, exponent])) });
        }
        Ok(base)
    }

    fn atom(&mut self) -> Result<Tree, Fault> {
        let at = self.at();
        let word = self.word().clone();
        self.advance();
        match word {
            Word::Number(value) => Ok(Tree { at, kind: Kind::Constant(value) }),
            Word::Name(name) => self.named(&name, at),
            Word::Sign("(") => {
                let inside = self.sum()?;
                self.close(at)?;
                Ok(inside)
            }
            word => {
                let expected = "a number, a name or '('";
                Err(fault(at, word.shown(), expected, "Something is missing before it, or it is too many."))
            }
        }
    }

    fn named(&mut self, name: &str, at: Position) -> Result<Tree, Fault> {
        let calls = matches!(self.word(), Word::Sign("("));
        if name == "if" {
            return self.choice(at);
        }
        if let Some(&(_, function)) = FUNCTIONS.iter().find(|(known, _)| *known == name) {
            return self.call(name, function, at);
        }
        if name == "pi" {
            return Ok(Tree { at, kind: Kind::Constant(core::f64::consts::PI) });
        }
        let Some(index) = self.names.usable.iter().position(|usable| *usable == name) else {
            return Err(self.unknown(name, at, calls));
        };
        if calls {
            let remedy = format!("Write {name}*(...) for a product.");
            return Err(fault(at, format!("'{name}('"), "a function before '('", &remedy));
        }
        Ok(Tree { at, kind: Kind::Name(index) })
    }

    fn unknown(&self, name: &str, at: Position, calls: bool) -> Fault {
        let found = format!("the name '{name}'");
        if let Some((_, reason)) = self.names.absent.iter().find(|(absent, _)| *absent == name) {
            return fault(at, found, &format!("a name that exists here: {}", self.list()), reason);
        }
        if calls {
            let functions: Vec<&str> = FUNCTIONS.iter().map(|(name, _)| *name).chain(["if"]).collect();
            let remedy = format!("The functions are {}.", functions.join(", "));
            return fault(at, format!("'{name}('"), "a function", &remedy);
        }
        let remedy = format!("Give it a value beside the formula, as in '{name}: 1.5', or correct the name.");
        fault(at, found, &format!("one of {}", self.list()), &remedy)
    }

    fn list(&self) -> String {
        let names: Vec<&str> = self.names.usable.iter().filter(|name| !name.is_empty()).copied().collect();
        names.join(", ")
    }

    fn choice(&mut self, at: Position) -> Result<Tree, Fault> {
        let opened = self.at();
        let usage = "Write if(dT > 0, a, b): a condition, the value where it holds, and the other value.";
        if !self.take("(") {
            return Err(fault(opened, self.word().shown(), "'(' after if", usage));
        }
        let condition = self.condition()?;
        let mut values = Vec::with_capacity(2);
        for _ in 0..2 {
            if !self.take(",") {
                return Err(fault(self.at(), self.word().shown(), "',' and a value", usage));
            }
            values.push(self.sum()?);
        }
        self.close(opened)?;
        let [yes, no] = values.try_into().map_err(|_| fault(at, "if", "two values", usage))?;
        Ok(Tree { at, kind: Kind::If(Box::new(condition), Box::new([yes, no])) })
    }

    fn call(&mut self, name: &str, function: Function, at: Position) -> Result<Tree, Fault> {
        let opened = self.at();
        if !self.take("(") {
            let remedy = format!("Write {name}(...).");
            return Err(fault(opened, self.word().shown(), &format!("'(' after {name}"), &remedy));
        }
        let mut arguments = vec![self.sum()?];
        let several = matches!(function, Function::Min | Function::Max);
        while several && self.take(",") {
            arguments.push(self.sum()?);
        }
        self.close(opened)?;
        if several && arguments.len() < 2 {
            let remedy = format!("Write {name}(a, b).");
            return Err(fault(at, format!("{name} of one number"), "two numbers or more", &remedy));
        }
        Ok(Tree { at, kind: Kind::Call(function, arguments) })
    }
}
