//! The functions of version 2.0 (<https://fmi-standard.org>).

use std::ffi::{CStr, c_char, c_int, c_uint, c_void};
use std::ptr;

use super::alike::{both, of_another_type, without};
use super::calls::{self, ERROR, Instance, Listener, Status, answer, call, contents_at, say, text};
use crate::unit::Refusal;

/// `fmi2CallbackFunctions`, as far as it is used.
#[repr(C)]
struct Callbacks {
    /// The format of the message is that of `printf`.
    logger:
        Option<unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...)>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// Messages go to a function of the importing program.
struct Log {
    callbacks: *const Callbacks,
    name: std::ffi::CString,
}

impl Listener for Log {
    fn hear(&self, status: Status, category: &CStr, message: &CStr) {
        // They live as long as the instance.
        let Some(callbacks) = (unsafe { self.callbacks.as_ref() }) else { return };
        if let Some(logger) = callbacks.logger {
            // "%s": a percent sign in the message is no format.
            unsafe {
                logger(
                    callbacks.environment,
                    self.name.as_ptr(),
                    status,
                    category.as_ptr(),
                    c"%s".as_ptr(),
                    message.as_ptr(),
                );
            }
        }
    }
}

/// The types have their usual sizes.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// The version of the standard.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// Whether remarks are passed on that are no errors.
#[unsafe(no_mangle)]
extern "C" fn fmi2SetDebugLogging(
    instance: *mut c_void,
    on: c_int,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    call::<Log>(instance, |instance| {
        instance.talkative = on != 0;
        Ok(())
    })
}

/// Makes an instance; `kind` is 1 for co-simulation.
#[unsafe(no_mangle)]
extern "C" fn fmi2Instantiate(
    name: *const c_char,
    kind: c_int,
    token: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    _visible: c_int,
    logging: c_int,
) -> *mut c_void {
    let name = if name.is_null() { c"".to_owned() } else { unsafe { CStr::from_ptr(name) }.to_owned() };
    let log = Log { callbacks, name };
    if kind != 1 {
        say(&log, ERROR, "this unit is for co-simulation, not for model exchange");
        return ptr::null_mut();
    }
    Instance::make(log, logging != 0, &text(token), || contents_at(&path_of(&text(resources))?))
}

/// The path of an address `file:///folder`, in which `%20` is a space.
fn path_of(address: &str) -> Result<String, String> {
    let wrong = || format!("found the resources at '{address}', expected an address such as file:///folder");
    let rest = address.strip_prefix("file:").ok_or_else(wrong)?;
    let mut rest = rest.strip_prefix("//localhost").or_else(|| rest.strip_prefix("//")).unwrap_or(rest);
    // On Windows file:///C:/folder is C:/folder.
    if rest.as_bytes().get(2) == Some(&b':') {
        rest = rest.trim_start_matches('/');
    }
    let mut bytes = Vec::new();
    let mut signs = rest.bytes();
    while let Some(sign) = signs.next() {
        if sign == b'%' {
            let mut digit = || signs.next().and_then(|sign| char::from(sign).to_digit(16)).ok_or_else(wrong);
            let code = 16 * digit()? + digit()?;
            bytes.push(u8::try_from(code).map_err(|_| wrong())?);
        } else {
            bytes.push(sign);
        }
    }
    String::from_utf8(bytes).map_err(|_| wrong())
}

/// Notes start and stop.
#[unsafe(no_mangle)]
extern "C" fn fmi2SetupExperiment(
    instance: *mut c_void,
    _tolerance_defined: c_int,
    _tolerance: f64,
    start: f64,
    stop_defined: c_int,
    stop: f64,
) -> Status {
    call::<Log>(instance, |instance| {
        instance.period = (start, (stop_defined != 0).then_some(stop));
        Ok(())
    })
}

/// The start is being set from now on.
#[unsafe(no_mangle)]
extern "C" fn fmi2EnterInitializationMode(instance: *mut c_void) -> Status {
    call::<Log>(instance, |instance| instance.unit.enter_initialization(instance.period.0, instance.period.1))
}

/// Reads variables.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetReal(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *mut f64,
) -> Status {
    calls::get::<Log>(instance, (references, count), (values, count))
}

/// Sets variables.
#[unsafe(no_mangle)]
extern "C" fn fmi2SetReal(
    instance: *mut c_void,
    references: *const c_uint,
    count: usize,
    values: *const f64,
) -> Status {
    calls::set::<Log>(instance, (references, count), (values, count))
}

/// Makes a communication step.
#[unsafe(no_mangle)]
extern "C" fn fmi2DoStep(instance: *mut c_void, from: f64, length: f64, _no_earlier_state: c_int) -> Status {
    call::<Log>(instance, |instance| instance.unit.step(from, length))
}

/// What became of a step that was discarded: the time that was reached.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetRealStatus(instance: *mut c_void, kind: c_int, value: *mut f64) -> Status {
    const LAST_SUCCESSFUL_TIME: c_int = 2;
    call::<Log>(instance, |instance| {
        if kind != LAST_SUCCESSFUL_TIME {
            return Err(Refusal::Discard(
                "fmi2GetRealStatus: only the last successful time is known".to_owned(),
            ));
        }
        answer(value, instance.unit.time());
        Ok(())
    })
}

/// Whether the unit wants the simulation to end: never.
#[unsafe(no_mangle)]
extern "C" fn fmi2GetBooleanStatus(instance: *mut c_void, _kind: c_int, value: *mut c_int) -> Status {
    call::<Log>(instance, |_| {
        answer(value, 0);
        Ok(())
    })
}

both! {
    fmi2FreeInstance, fmi2ExitInitializationMode, fmi2Terminate, fmi2Reset,
    fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate,
    fmi2SerializedFMUstateSize, fmi2SerializeFMUstate, fmi2DeSerializeFMUstate
}

of_another_type! {
    fmi2GetInteger(*mut c_void);
    fmi2GetBoolean(*mut c_void);
    fmi2GetString(*mut c_void);
    fmi2SetInteger(*const c_void);
    fmi2SetBoolean(*const c_void);
    fmi2SetString(*const c_void);
}

without! {
    fmi2GetDirectionalDerivative(*const c_uint, usize, *const c_uint, usize, *const f64, *mut f64);
    fmi2SetRealInputDerivatives(*const c_uint, usize, *const c_int, *const f64);
    fmi2GetRealOutputDerivatives(*const c_uint, usize, *const c_int, *mut f64);
    fmi2CancelStep();
    fmi2GetStatus(c_int, *mut c_int);
    fmi2GetIntegerStatus(c_int, *mut c_int);
    fmi2GetStringStatus(c_int, *mut c_void);
    fmi2EnterEventMode();
    fmi2NewDiscreteStates(*mut c_void);
    fmi2EnterContinuousTimeMode();
    fmi2CompletedIntegratorStep(c_int, *mut c_int, *mut c_int);
    fmi2SetTime(f64);
    fmi2SetContinuousStates(*const f64, usize);
    fmi2GetDerivatives(*mut f64, usize);
    fmi2GetEventIndicators(*mut f64, usize);
    fmi2GetContinuousStates(*mut f64, usize);
    fmi2GetNominalsOfContinuousStates(*mut f64, usize);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_paths() {
        for (address, path) in [
            ("file:///tmp/a%20b/resources", "/tmp/a b/resources"),
            ("file:/tmp/a", "/tmp/a"),
            ("file://localhost/tmp/a", "/tmp/a"),
            ("file:///C:/units/%C3%A4", "C:/units/ä"),
        ] {
            assert_eq!(path_of(address).as_deref(), Ok(path));
        }
        for address in ["/tmp/a", "file:///a%2", "file:///a%+f"] {
            assert!(path_of(address).is_err(), "{address}");
        }
    }
}
