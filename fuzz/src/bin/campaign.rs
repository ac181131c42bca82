//! Mutates the calls of a folder, on stable Rust and without guidance: `campaign FOLDER COUNT SEED`.
//!
//! Prints a table of the inputs and the panics of each function; an input that panics is written beside the calls.
//! Ends with 1 if there is one. The n-th input depends on the seed and n only.

use std::panic::catch_unwind;
use std::path::Path;
use std::time::Instant;

use mascarin_fuzz::TARGETS;

/// Numbers at which arithmetic breaks first.
const NUMBERS: [&str; 20] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "7",
    "1e-300",
    "1e308",
    "-1e308",
    "5e-324",
    "1e-9",
    "1e9",
    "0.5",
    "100",
    "-50",
    "4294967295",
    "18446744073709551615",
    "9007199254740993",
    "1.5",
    "null",
];

/// Marsaglia (2003), J. Stat. Softw. 8(14), doi:10.18637/jss.v008.i14: 64 bits, shifts 13, 7, 17.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        usize::try_from(self.0 % (limit.max(1) as u64)).unwrap_or(0)
    }
}

fn main() -> std::io::Result<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [folder, count, seed] = words.as_slice() else {
        eprintln!("expected: campaign FOLDER COUNT SEED");
        std::process::exit(2);
    };
    let (Ok(count), Ok(seed)) = (count.parse::<u64>(), seed.parse::<u64>()) else {
        eprintln!("expected whole numbers: COUNT and SEED");
        std::process::exit(2);
    };
    let mut files: Vec<_> =
        std::fs::read_dir(folder)?.filter_map(Result::ok).map(|entry| entry.path()).collect();
    files.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
    files.sort();
    let seeds: Vec<Vec<u8>> = files.iter().map(std::fs::read).collect::<Result<_, _>>()?;
    if seeds.is_empty() {
        eprintln!("{folder}: found no .json, expected calls as fuzz/calls.py writes them");
        std::process::exit(2);
    }
    std::panic::set_hook(Box::new(|_| {}));
    println!("| function | inputs | taken | panics | longest s |\n|---|---:|---:|---:|---:|");
    let mut defects = 0;
    for (name, target) in TARGETS {
        let (mut taken, mut panics, mut longest) = (0, 0, 0.0_f64);
        for n in 0..count {
            let mut random = Random((seed << 32) ^ (n.wrapping_mul(0x9e37_79b9_7f4a_7c15)) | 1);
            let input = mutated(&seeds[random.below(seeds.len())], &mut random);
            let began = Instant::now();
            let ended = catch_unwind(|| target(&input));
            taken += u64::from(matches!(ended, Ok(true)));
            if ended.is_err() {
                panics += 1;
                std::fs::write(Path::new(folder).join(format!("panic-{name}-{seed}-{n}.txt")), &input)?;
            }
            longest = longest.max(began.elapsed().as_secs_f64());
        }
        println!("| {name} | {count} | {taken} | {panics} | {longest:.2} |");
        defects += panics;
    }
    std::process::exit(i32::from(defects > 0));
}

/// One to three numbers of a JSON text replaced, or a part of it removed or repeated.
fn mutated(text: &[u8], random: &mut Random) -> Vec<u8> {
    let mut text = text.to_vec();
    for _ in 0..=random.below(3) {
        let numbers = numbers(&text);
        match random.below(12) {
            0 => {
                let first = random.below(text.len());
                let last = (first + random.below(40)).min(text.len());
                text.drain(first..last);
            }
            1 => {
                let first = random.below(text.len());
                let last = (first + random.below(80)).min(text.len());
                let part = text[first..last].to_vec();
                text.splice(last..last, part);
            }
            _ if !numbers.is_empty() => {
                let (first, last) = numbers[random.below(numbers.len())];
                let new = match random.below(3) {
                    0 => {
                        let (from, to) = numbers[random.below(numbers.len())];
                        text[from..to].to_vec()
                    }
                    _ => NUMBERS[random.below(NUMBERS.len())].as_bytes().to_vec(),
                };
                text.splice(first..last, new);
            }
            _ => {}
        }
    }
    text
}

/// First and last byte of each number outside quotes.
fn numbers(text: &[u8]) -> Vec<(usize, usize)> {
    let (mut found, mut quoted, mut at) = (Vec::new(), false, 0);
    while at < text.len() {
        let letter = text[at];
        if letter == b'"' {
            quoted = !quoted;
        }
        if !quoted && (letter.is_ascii_digit() || letter == b'-') {
            let first = at;
            while at < text.len() && matches!(text[at], b'0'..=b'9' | b'-' | b'+' | b'.' | b'e' | b'E') {
                at += 1;
            }
            found.push((first, at));
        } else {
            at += 1;
        }
    }
    found
}
