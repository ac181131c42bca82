//! What a page calls. Numbers and positions in the memory of the module are all that crosses this border.
//!
//! Its only `unsafe` is the promise that no other function has the same name, without which a module exports none. The page writes the files
//! into memory that [`reserve`] has given it, and reads records, texts and numbers from where the module says that they are, before it
//! calls anything else. A call gives 0 when it is done, and 1 with a [`message`]. A panic ends the module: its text is the message then.

#![allow(
    unsafe_code,
    reason = "`no_mangle` is an unsafe attribute, and a module for browsers has no exports without it"
)]

use std::panic;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::model::Model;

/// The files of the model, what they have become, and the last message.
struct State {
    files: [Vec<u8>; 3],
    model: Option<Model>,
    message: String,
}

static STATE: Mutex<State> =
    Mutex::new(State { files: [const { Vec::new() }; 3], model: None, message: String::new() });

/// Text of a panic, which happens while the state is in use.
static PANIC: Mutex<String> = Mutex::new(String::new());

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Keeps the text of a panic.
fn note_panics() {
    panic::set_hook(Box::new(|about| {
        if let Ok(mut text) = PANIC.try_lock() {
            *text = about.to_string();
        }
    }));
}

/// Does something with the model; a refusal becomes the message.
fn with_model(work: impl FnOnce(&mut Model) -> Result<(), String>) -> i32 {
    let mut state = state();
    let done = state.model.as_mut().map_or_else(|| Err("no model is loaded".to_owned()), work);
    match done {
        Ok(()) => 0,
        Err(text) => {
            state.message = text;
            1
        }
    }
}

/// Room for a file: 0 is `run.json`, 1 `building.json`, 2 `forcing.bin`.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(file: usize, bytes: usize) -> *mut u8 {
    note_panics();
    let room = &mut state().files[file];
    *room = vec![0; bytes];
    room.as_mut_ptr()
}

/// Makes a model of the files.
#[unsafe(no_mangle)]
pub extern "C" fn load() -> i32 {
    let files = core::mem::take(&mut state().files);
    let model = Model::read(&files);
    let mut state = state();
    match model {
        Ok(model) => {
            state.model = Some(model);
            0
        }
        Err(text) => {
            state.message = text;
            1
        }
    }
}

/// Back to the values of the building.
#[unsafe(no_mangle)]
pub extern "C" fn reset() -> i32 {
    with_model(|model| {
        model.reset();
        Ok(())
    })
}

/// Sets a number of the parameter vector.
#[unsafe(no_mangle)]
pub extern "C" fn set(position: usize, value: f64) -> i32 {
    with_model(|model| model.set(position, value))
}

/// Runs the building.
#[unsafe(no_mangle)]
pub extern "C" fn run() -> i32 {
    with_model(Model::run)
}

/// Where the records of the last run are, row by row.
#[unsafe(no_mangle)]
pub extern "C" fn records() -> *const f64 {
    state().model.as_ref().map_or(core::ptr::null(), |model| model.records().as_ptr())
}

/// How many there are.
#[unsafe(no_mangle)]
pub extern "C" fn records_length() -> usize {
    state().model.as_ref().map_or(0, |model| model.records().len())
}

/// Where the balances and findings of the last run are, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn findings() -> *const u8 {
    state().model.as_ref().map_or(core::ptr::null(), |model| model.findings().as_ptr())
}

/// Its bytes.
#[unsafe(no_mangle)]
pub extern "C" fn findings_length() -> usize {
    state().model.as_ref().map_or(0, |model| model.findings().len())
}

/// Where the last message is: that of a panic, where there was one.
#[unsafe(no_mangle)]
pub extern "C" fn message() -> *const u8 {
    let panicked = PANIC.lock().unwrap_or_else(PoisonError::into_inner);
    if panicked.is_empty() { state().message.as_ptr() } else { panicked.as_ptr() }
}

/// Its bytes.
#[unsafe(no_mangle)]
pub extern "C" fn message_length() -> usize {
    let panicked = PANIC.lock().unwrap_or_else(PoisonError::into_inner);
    if panicked.is_empty() { state().message.len() } else { panicked.len() }
}
