//! What the functions of both versions of the standard share.

use std::any::Any;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::{ptr, slice};

use crate::saved::Saved;
use crate::unit::{Outcome, Refusal, Unit};
use mascarin_contents::Contents;

/// Result of a call, the same in both versions of the standard.
pub(super) type Status = c_int;
pub(super) const OK: Status = 0;
pub(super) const DISCARD: Status = 2;
pub(super) const ERROR: Status = 3;
pub(super) const FATAL: Status = 4;

/// Where messages go.
pub(super) trait Listener {
    /// Passes a message on; `category` is one of the model description.
    fn hear(&self, status: Status, category: &CStr, message: &CStr);
}

/// What an instance of a unit is to the importing program: a pointer to this.
pub(super) struct Instance<L> {
    pub(super) unit: Unit,
    pub(super) listener: L,
    /// Whether remarks are passed on that are no errors.
    pub(super) talkative: bool,
    /// Start and stop that version 2.0 sets before the initialization [s].
    pub(super) period: (f64, Option<f64>),
    /// The unit stopped on a panic: nothing of it can be used.
    failed: bool,
}

/// A message as C reads it.
fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

pub(super) fn say(listener: &impl Listener, status: Status, text: &str) {
    let category = if status == OK { c"logInfo" } else { c"logStatusError" };
    listener.hear(status, category, &c_text(text));
}

impl<L: Listener> Instance<L> {
    /// A new instance for the importing program; null, with a message, where it cannot be made.
    pub(super) fn make(
        listener: L,
        talkative: bool,
        token: &str,
        read: impl FnOnce() -> Result<Contents, String>,
    ) -> *mut c_void {
        let made = catch_unwind(AssertUnwindSafe(|| {
            let contents = read()?;
            if contents.token == token {
                return Ok(Unit::new(contents));
            }
            Err(format!(
                "found the token '{token}', expected '{}': library and model description are not of one unit",
                contents.token
            ))
        }));
        match made.unwrap_or_else(|panic| Err(words(&*panic))) {
            Ok(unit) => {
                let instance = Self { unit, listener, talkative, period: (0.0, None), failed: false };
                Box::into_raw(Box::new(instance)).cast()
            }
            Err(text) => {
                say(&listener, ERROR, &text);
                ptr::null_mut()
            }
        }
    }
}

/// What a panic says.
fn words(panic: &(dyn Any + Send)) -> String {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    format!("a defect in Mascarin: {text}. Please report it, with the unit")
}

/// Carries out a call to an instance: a refusal and a panic become a status and a message.
pub(super) fn call<L: Listener>(
    instance: *mut c_void,
    work: impl FnOnce(&mut Instance<L>) -> Outcome,
) -> Status {
    // An instance is what `Instance::make` has given, and is used by one thread at a time, by the standard.
    let Some(instance) = (unsafe { instance.cast::<Instance<L>>().as_mut() }) else { return ERROR };
    if instance.failed {
        return FATAL;
    }
    let (status, text) = match catch_unwind(AssertUnwindSafe(|| work(instance))) {
        Ok(Ok(())) => return OK,
        Ok(Err(Refusal::Discard(text))) => (DISCARD, text),
        Ok(Err(Refusal::Error(text))) => (ERROR, text),
        Err(panic) => {
            instance.failed = true;
            (FATAL, words(&*panic))
        }
    };
    say(&instance.listener, status, &text);
    status
}

/// Gives an instance back.
pub(super) fn free<L>(instance: *mut c_void) {
    if !instance.is_null() {
        // Made by `Instance::make`, and not used again, by the standard. A panic while it is dropped must not leave.
        let _ = catch_unwind(|| drop(unsafe { Box::from_raw(instance.cast::<Instance<L>>()) }));
    }
}

/// A list that C passes as a pointer and a number.
pub(super) fn list<'a, T>(first: *const T, count: usize) -> &'a [T] {
    if first.is_null() || count == 0 { &[] } else { unsafe { slice::from_raw_parts(first, count) } }
}

/// The same, to be written.
pub(super) fn list_mut<'a, T>(first: *mut T, count: usize) -> &'a mut [T] {
    if first.is_null() || count == 0 { &mut [] } else { unsafe { slice::from_raw_parts_mut(first, count) } }
}

/// A text that C passes; empty for null.
pub(super) fn text<'a>(first: *const c_char) -> std::borrow::Cow<'a, str> {
    if first.is_null() { "".into() } else { unsafe { CStr::from_ptr(first) }.to_string_lossy() }
}

/// Writes where C wants an answer; nowhere for null.
pub(super) fn answer<T>(place: *mut T, value: T) {
    if !place.is_null() {
        unsafe { place.write(value) };
    }
}

/// As many values as variables.
fn require_as_many(references: usize, values: usize) -> Outcome {
    if references == values {
        return Ok(());
    }
    Err(Refusal::Error(format!("found {values} values for {references} variables, expected one for each")))
}

/// Reads variables.
pub(super) fn get<L: Listener>(
    instance: *mut c_void,
    references: (*const u32, usize),
    values: (*mut f64, usize),
) -> Status {
    call::<L>(instance, |instance| {
        require_as_many(references.1, values.1)?;
        instance.unit.get(list(references.0, references.1), list_mut(values.0, values.1))
    })
}

/// Sets variables.
pub(super) fn set<L: Listener>(
    instance: *mut c_void,
    references: (*const u32, usize),
    values: (*const f64, usize),
) -> Status {
    call::<L>(instance, |instance| {
        require_as_many(references.1, values.1)?;
        instance.unit.set(list(references.0, references.1), list(values.0, values.1))
    })
}

/// Refuses variables of another type than the only one that there is.
pub(super) fn no_variables<L: Listener>(instance: *mut c_void, function: &str, count: usize) -> Status {
    call::<L>(instance, |_| {
        if count == 0 {
            return Ok(());
        }
        Err(Refusal::Error(format!(
            "{function}: all variables of this unit are 64-bit numbers (Float64, Real)"
        )))
    })
}

/// Refuses a function of the standard that this unit does not have.
pub(super) fn unsupported<L: Listener>(instance: *mut c_void, function: &str) -> Status {
    call::<L>(instance, |_| {
        Err(Refusal::Error(format!(
            "{function}: this unit for co-simulation does not have this function; its model description says so"
        )))
    })
}

/// Keeps the present state, in place of one that was kept before.
pub(super) fn keep_state<L: Listener>(instance: *mut c_void, state: *mut *mut c_void) -> Status {
    call::<L>(instance, |instance| {
        give_state(state, instance.unit.save());
        Ok(())
    })
}

fn give_state(place: *mut *mut c_void, saved: Saved) {
    if place.is_null() {
        return;
    }
    // Either null, or a state that this unit has given.
    match unsafe { (*place).cast::<Saved>().as_mut() } {
        Some(old) => *old = saved,
        None => answer(place, Box::into_raw(Box::new(saved)).cast()),
    }
}

fn state_at<'a>(state: *mut c_void) -> Outcome<&'a Saved> {
    let saved = unsafe { state.cast::<Saved>().as_ref() };
    saved.ok_or_else(|| Refusal::Error("found no state (null); keep one first".to_owned()))
}

/// Goes back to a state.
pub(super) fn restore_state<L: Listener>(instance: *mut c_void, state: *mut c_void) -> Status {
    call::<L>(instance, |instance| instance.unit.restore(state_at(state)?))
}

/// Forgets a state.
pub(super) fn free_state<L: Listener>(instance: *mut c_void, state: *mut *mut c_void) -> Status {
    call::<L>(instance, |_| {
        if !state.is_null() {
            let kept = unsafe { *state };
            if !kept.is_null() {
                drop(unsafe { Box::from_raw(kept.cast::<Saved>()) });
            }
            answer(state, ptr::null_mut());
        }
        Ok(())
    })
}

/// Says how many bytes a state has.
pub(super) fn state_size<L: Listener>(instance: *mut c_void, state: *mut c_void, size: *mut usize) -> Status {
    call::<L>(instance, |instance| {
        answer(size, state_at(state)?.to_bytes(instance.unit.contents()).len());
        Ok(())
    })
}

/// Writes a state as bytes.
pub(super) fn write_state<L: Listener>(
    instance: *mut c_void,
    state: *mut c_void,
    place: *mut u8,
    size: usize,
) -> Status {
    call::<L>(instance, |instance| {
        let bytes = state_at(state)?.to_bytes(instance.unit.contents());
        let place = list_mut(place, size);
        if place.len() < bytes.len() {
            return Err(Refusal::Error(format!(
                "found {} bytes for a state of {}; ask for its size first",
                place.len(),
                bytes.len()
            )));
        }
        place[..bytes.len()].copy_from_slice(&bytes);
        Ok(())
    })
}

/// Reads a state from bytes.
pub(super) fn read_state<L: Listener>(
    instance: *mut c_void,
    bytes: (*const u8, usize),
    state: *mut *mut c_void,
) -> Status {
    call::<L>(instance, |instance| {
        let saved = Saved::from_bytes(instance.unit.contents(), list(bytes.0, bytes.1));
        give_state(state, saved.map_err(Refusal::Error)?);
        Ok(())
    })
}

/// Ends a run.
pub(super) fn terminate<L: Listener>(instance: *mut c_void) -> Status {
    call::<L>(instance, |instance| {
        let remark = instance.unit.terminate();
        if instance.talkative {
            say(&instance.listener, OK, &remark);
        }
        Ok(())
    })
}

/// Reads the contents of a unit from its folder `resources`.
pub(super) fn contents_at(folder: &str) -> Result<Contents, String> {
    crate::resources::read(Path::new(folder))
}
