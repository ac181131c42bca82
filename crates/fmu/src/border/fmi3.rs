//! The functions of version 3.0 (<https://fmi-standard.org/docs/3.0.2/>).

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr;

use super::alike::{both, of_another_type, without};
use super::calls::{self, ERROR, Instance, Listener, Status, answer, call, contents_at, say, text};

/// `fmi3LogMessageCallback`.
type LogMessage = Option<unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char)>;

/// Messages go to a function of the importing program.
struct Log {
    environment: *mut c_void,
    function: LogMessage,
}

impl Listener for Log {
    fn hear(&self, status: Status, category: &CStr, message: &CStr) {
        if let Some(function) = self.function {
            // Both come from the importing program, and live as long as the instance.
            unsafe { function(self.environment, status, category.as_ptr(), message.as_ptr()) };
        }
    }
}

/// The version of the standard.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

/// Whether remarks are passed on that are no errors.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetDebugLogging(
    instance: *mut c_void,
    on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    call::<Log>(instance, |instance| {
        instance.talkative = on;
        Ok(())
    })
}

/// Makes an instance.
#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    logging: bool,
    events: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: LogMessage,
    _update: *const c_void,
) -> *mut c_void {
    let log = Log { environment, function: log };
    if events {
        say(&log, ERROR, "found eventModeUsed, but this unit has no events; its model description says so");
        return ptr::null_mut();
    }
    Instance::make(log, logging, &text(token), || contents_at(&text(resources)))
}

/// The start is being set from now on.
#[unsafe(no_mangle)]
extern "C" fn fmi3EnterInitializationMode(
    instance: *mut c_void,
    _tolerance_defined: bool,
    _tolerance: f64,
    start: f64,
    stop_defined: bool,
    stop: f64,
) -> Status {
    call::<Log>(instance, |instance| instance.unit.enter_initialization(start, stop_defined.then_some(stop)))
}

/// Reads variables.
#[unsafe(no_mangle)]
extern "C" fn fmi3GetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *mut f64,
    values_count: usize,
) -> Status {
    calls::get::<Log>(instance, (references, count), (values, values_count))
}

/// Sets variables.
#[unsafe(no_mangle)]
extern "C" fn fmi3SetFloat64(
    instance: *mut c_void,
    references: *const u32,
    count: usize,
    values: *const f64,
    values_count: usize,
) -> Status {
    calls::set::<Log>(instance, (references, count), (values, values_count))
}

/// Makes a communication step.
#[unsafe(no_mangle)]
extern "C" fn fmi3DoStep(
    instance: *mut c_void,
    from: f64,
    length: f64,
    _no_earlier_state: bool,
    event: *mut bool,
    terminate: *mut bool,
    early: *mut bool,
    last: *mut f64,
) -> Status {
    call::<Log>(instance, |instance| {
        for place in [event, terminate, early] {
            answer(place, false);
        }
        let made = instance.unit.step(from, length);
        answer(last, instance.unit.time());
        made
    })
}

/// Refused: this unit is for co-simulation.
#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateModelExchange(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    environment: *mut c_void,
    log: LogMessage,
) -> *mut c_void {
    say(&Log { environment, function: log }, ERROR, "this unit is for co-simulation, not for model exchange");
    ptr::null_mut()
}

/// Refused: this unit is for co-simulation.
#[unsafe(no_mangle)]
extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: bool,
    _logging: bool,
    environment: *mut c_void,
    log: LogMessage,
    _clock: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> *mut c_void {
    say(
        &Log { environment, function: log },
        ERROR,
        "this unit is for co-simulation, not for scheduled execution",
    );
    ptr::null_mut()
}

both! {
    fmi3FreeInstance, fmi3ExitInitializationMode, fmi3Terminate, fmi3Reset,
    fmi3GetFMUState, fmi3SetFMUState, fmi3FreeFMUState,
    fmi3SerializedFMUStateSize, fmi3SerializeFMUState, fmi3DeserializeFMUState
}

of_another_type! {
    fmi3GetFloat32(*mut c_void, usize);
    fmi3GetInt8(*mut c_void, usize);
    fmi3GetUInt8(*mut c_void, usize);
    fmi3GetInt16(*mut c_void, usize);
    fmi3GetUInt16(*mut c_void, usize);
    fmi3GetInt32(*mut c_void, usize);
    fmi3GetUInt32(*mut c_void, usize);
    fmi3GetInt64(*mut c_void, usize);
    fmi3GetUInt64(*mut c_void, usize);
    fmi3GetBoolean(*mut c_void, usize);
    fmi3GetString(*mut c_void, usize);
    fmi3GetBinary(*mut usize, *mut c_void, usize);
    fmi3GetClock(*mut c_void);
    fmi3SetFloat32(*const c_void, usize);
    fmi3SetInt8(*const c_void, usize);
    fmi3SetUInt8(*const c_void, usize);
    fmi3SetInt16(*const c_void, usize);
    fmi3SetUInt16(*const c_void, usize);
    fmi3SetInt32(*const c_void, usize);
    fmi3SetUInt32(*const c_void, usize);
    fmi3SetInt64(*const c_void, usize);
    fmi3SetUInt64(*const c_void, usize);
    fmi3SetBoolean(*const c_void, usize);
    fmi3SetString(*const c_void, usize);
    fmi3SetBinary(*const usize, *const c_void, usize);
    fmi3SetClock(*const c_void);
    fmi3GetIntervalDecimal(*mut f64, *mut c_int);
    fmi3GetIntervalFraction(*mut u64, *mut u64, *mut c_int);
    fmi3GetShiftDecimal(*mut f64);
    fmi3GetShiftFraction(*mut u64, *mut u64);
    fmi3SetIntervalDecimal(*const f64);
    fmi3SetIntervalFraction(*const u64, *const u64);
    fmi3SetShiftDecimal(*const f64);
    fmi3SetShiftFraction(*const u64, *const u64);
}

without! {
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EnterContinuousTimeMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(*mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64);
    fmi3GetNumberOfVariableDependencies(u32, *mut usize);
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize);
    fmi3GetDirectionalDerivative(*const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3GetAdjointDerivative(*const u32, usize, *const u32, usize, *const f64, usize, *mut f64, usize);
    fmi3GetOutputDerivatives(*const u32, usize, *const i32, *mut f64, usize);
    fmi3CompletedIntegratorStep(bool, *mut bool, *mut bool);
    fmi3SetTime(f64);
    fmi3SetContinuousStates(*const f64, usize);
    fmi3GetContinuousStateDerivatives(*mut f64, usize);
    fmi3GetEventIndicators(*mut f64, usize);
    fmi3GetContinuousStates(*mut f64, usize);
    fmi3GetNominalsOfContinuousStates(*mut f64, usize);
    fmi3GetNumberOfEventIndicators(*mut usize);
    fmi3GetNumberOfContinuousStates(*mut usize);
    fmi3ActivateModelPartition(u32, f64);
}
