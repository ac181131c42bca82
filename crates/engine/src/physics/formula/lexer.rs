//! The words of a formula.

use super::{Fault, Position};

/// A word of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Word {
    Number(f64),
    Name(String),
    /// One of `+ - * / ^ ( ) , < > <= >=`.
    Sign(&'static str),
    /// After the last one.
    End,
}

impl Word {
    /// As an error shows it.
    pub(crate) fn shown(&self) -> String {
        match self {
            Self::Number(value) => format!("the number {value}"),
            Self::Name(name) => format!("'{name}'"),
            Self::Sign(sign) => format!("'{sign}'"),
            Self::End => "the end of the formula".into(),
        }
    }
}

/// A word and where it begins.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Token {
    pub(crate) word: Word,
    pub(crate) at: Position,
}

/// Longer texts are no formulas of a law [characters].
const LONGEST: usize = 2000;
/// Signs of two characters come before those of one.
const SIGNS: [&str; 14] = ["**", "<=", ">=", "+", "-", "*", "/", "^", "(", ")", ",", "<", ">", "\0"];

/// Characters that stand in printed formulas, and what to write instead.
const PRINTED: [(char, &str); 12] = [
    ('·', "Write * for a product."),
    ('×', "Write * for a product."),
    ('÷', "Write / for a quotient."),
    ('−', "Write - (the sign of the keyboard)."),
    ('²', "Write ^2."),
    ('³', "Write ^3."),
    ('√', "Write sqrt(x)."),
    ('|', "Write abs(x) for a magnitude."),
    ('Δ', "Write dT for the temperature difference."),
    ('=', "Write a comparison with <, <=, > or >=; the formula itself has no equals sign."),
    ('%', "Write /100."),
    ('[', "Write round brackets."),
];

/// The words of a text, with [`Word::End`] as the last.
///
/// # Errors
/// A character that no formula has, and a text that is too long.
pub(crate) fn words(text: &str) -> Result<Vec<Token>, Fault> {
    let characters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let (mut place, mut at) = (0, Position { line: 1, column: 1 });
    if characters.len() > LONGEST {
        let found = format!("{} characters", characters.len());
        return Err(fault(at, found, &format!("at most {LONGEST}"), "Give a shorter formula."));
    }
    while let Some(&character) = characters.get(place) {
        let length = match character {
            '\n' => {
                (at, place) = (Position { line: at.line + 1, column: 1 }, place + 1);
                continue;
            }
            _ if character.is_whitespace() => 1,
            '0'..='9' | '.' => number(&characters[place..], at, &mut tokens)?,
            'a'..='z' | 'A'..='Z' | '_' => name(&characters[place..], at, &mut tokens),
            _ => sign(&characters[place..], at, &mut tokens)?,
        };
        place += length;
        at.column += u32::try_from(length).unwrap_or(u32::MAX);
    }
    tokens.push(Token { word: Word::End, at });
    Ok(tokens)
}

/// A number such as `2`, `0.5`, `.5` or `1.2e-3`; its length.
fn number(rest: &[char], at: Position, tokens: &mut Vec<Token>) -> Result<usize, Fault> {
    let digits = |from: usize| rest[from..].iter().take_while(|c| c.is_ascii_digit()).count();
    let mut length = digits(0);
    if rest.get(length) == Some(&'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(rest.get(length), Some('e' | 'E')) {
        let signed = usize::from(matches!(rest.get(length + 1), Some('+' | '-')));
        let exponent = digits(length + 1 + signed);
        if exponent > 0 {
            length += 1 + signed + exponent;
        }
    }
    let text: String = rest[..length].iter().collect();
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    let Some(value) = value else {
        return Err(fault(at, format!("'{text}'"), "a number", "Write a number such as 0.33 or 1.2e-3."));
    };
    if let Some(&next) = rest.get(length)
        && (next.is_alphabetic() || next == '_' || next == '.')
    {
        let remedy = format!("Write {text}*{next}... for a product.");
        return Err(fault(at, format!("'{text}{next}'"), "a sign after the number", &remedy));
    }
    tokens.push(Token { word: Word::Number(value), at });
    Ok(length)
}

fn name(rest: &[char], at: Position, tokens: &mut Vec<Token>) -> usize {
    // Names of outputs have dots inside.
    let letter = |c: Option<&char>| c.is_some_and(|c| c.is_ascii_alphabetic() || *c == '_');
    let inside =
        |k: usize, c: char| c.is_ascii_alphanumeric() || c == '_' || (c == '.' && letter(rest.get(k + 1)));
    let length = rest.iter().enumerate().take_while(|(k, c)| inside(*k, **c)).count();
    let name: String = rest[..length].iter().collect();
    tokens.push(Token { word: Word::Name(name), at });
    length
}

fn sign(rest: &[char], at: Position, tokens: &mut Vec<Token>) -> Result<usize, Fault> {
    let starts = |sign: &&&str| sign.chars().zip(rest).filter(|(a, b)| a == *b).count() == sign.len();
    if let Some(sign) = SIGNS.iter().find(starts) {
        // `**` is a power in other languages.
        let word = Word::Sign(if *sign == "**" { "^" } else { sign });
        tokens.push(Token { word, at });
        return Ok(sign.len());
    }
    let character = rest[0];
    let printed = PRINTED.iter().find(|(printed, _)| *printed == character);
    let remedy = printed.map_or("Remove it.", |(_, remedy)| remedy);
    Err(fault(at, format!("'{character}'"), "a number, a name, a sign or a bracket", remedy))
}

/// An error at a place.
pub(crate) fn fault(at: Position, found: impl Into<String>, expected: &str, remedy: &str) -> Fault {
    Fault { at, found: found.into(), expected: expected.into(), remedy: remedy.into() }
}
