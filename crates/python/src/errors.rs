//! Errors of the engine as Python exceptions; interruption, progress and panics of a running call.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use mascarin_engine::RunControl;
use mascarin_engine::error::EngineError;
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyKeyboardInterrupt};
use pyo3::prelude::*;

create_exception!(
    mascarin._engine,
    EngineInputError,
    PyException,
    "Arrays, options or descriptions the engine refuses."
);
create_exception!(
    mascarin._engine,
    EngineSolverError,
    PyException,
    "A step or a warm-up that did not converge, or that led to what is impossible."
);
create_exception!(
    mascarin._engine,
    EngineDefect,
    PyException,
    "A defect of the engine itself: it stopped on a panic."
);

/// How often a waiting call checks for Ctrl-C and reports progress.
const PULSE: Duration = Duration::from_millis(50);

/// How often `interrupt` was called: a call that finds another number than at its start stops.
static INTERRUPTIONS: AtomicUsize = AtomicUsize::new(0);

/// Stops all calls that are running now, on whatever thread: Python gives Ctrl-C to its first thread only.
#[pyfunction]
pub fn interrupt() {
    INTERRUPTIONS.fetch_add(1, Ordering::Relaxed);
}

/// The Python exception of an engine error.
pub fn to_python(error: &EngineError) -> PyErr {
    let text = error.to_string();
    match error {
        EngineError::Description(_) | EngineError::Input(_) => EngineInputError::new_err(text),
        EngineError::NotConverged { .. }
        | EngineError::WarmUpNotConverged { .. }
        | EngineError::Impossible { .. } => EngineSolverError::new_err(text),
        EngineError::Interrupted => PyKeyboardInterrupt::new_err(text),
    }
}

/// The Python exception of a panic.
fn defect(panic: &(dyn std::any::Any + Send)) -> PyErr {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message");
    EngineDefect::new_err(format!("the engine stopped on an internal fault: {text}"))
}

/// The whole of a call from Python: a panic in it becomes an exception that Python catches as any other.
pub fn caught<T>(work: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    // What `work` was changing is dropped with it: nothing half-changed is seen afterwards.
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(defect(&*panic)))
}

/// Runs `work` that cannot be stopped on another thread with the GIL released. After Ctrl-C the call returns at once and the thread,
/// which owns all that it works on, ends by itself.
pub fn abandonable<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, EngineError> + Send + 'static,
) -> PyResult<T> {
    let (sender, receiver) = sync_channel(1);
    std::thread::spawn(move || {
        // After Ctrl-C nobody waits for the result.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
    });
    let receiver = Mutex::new(receiver);
    let wait = || receiver.lock().map_or(Err(RecvTimeoutError::Disconnected), |end| end.recv_timeout(PULSE));
    loop {
        match py.detach(wait) {
            Ok(Ok(result)) => return result.map_err(|error| to_python(&error)),
            Ok(Err(panic)) => return Err(defect(&*panic)),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(EngineDefect::new_err("the engine gave no result"));
            }
        }
    }
}

/// What is called with the number of units done, and which number of a run that is.
pub type Report<'a, 'py> = (&'a Bound<'py, PyAny>, fn(&RunControl) -> usize);

/// Members done.
pub fn done_members(watch: &RunControl) -> usize {
    watch.done.load(Ordering::Relaxed)
}

/// Steps done, without those of the warm-up.
pub fn done_steps(watch: &RunControl) -> usize {
    watch.steps.load(Ordering::Relaxed)
}

/// What a worker sends to the thread that waits for it.
enum Sent {
    Block(Vec<f64>),
    Request,
    End,
}

/// Gives a block of numbers to Python; it waits until the one before has been taken.
pub type Give<'a> = &'a dyn Fn(Vec<f64>) -> Result<(), EngineError>;

/// Asks Python for the next block of numbers.
pub type Ask<'a> = &'a dyn Fn() -> Result<Vec<f64>, EngineError>;

/// What Python takes from a worker and gives to it, in blocks of numbers.
pub struct Exchange<T, G> {
    /// Called with each block of the worker.
    pub take: T,
    /// Gives the next block for the worker; none after the last one.
    pub give: G,
}

/// Blocks for a worker, one of which is prepared while the worker does without.
struct Supply<G> {
    give: G,
    prepared: Option<Vec<f64>>,
    sender: SyncSender<Vec<f64>>,
}

impl<G: FnMut() -> PyResult<Option<Vec<f64>>>> Supply<G> {
    /// Hands the prepared block over, and prepares the next one.
    fn hand_over(&mut self) -> PyResult<()> {
        // An empty block where there is none: the engine says what it expected. A worker that is gone needs none.
        let _ = self.sender.send(self.prepared.take().unwrap_or_default());
        self.prepare()
    }

    fn prepare(&mut self) -> PyResult<()> {
        self.prepared = (self.give)()?;
        Ok(())
    }
}

/// Runs `work` on another thread with the GIL released, passing Ctrl-C on to it and progress to `report`.
pub fn attended<T: Send>(
    py: Python<'_>,
    report: Option<Report<'_, '_>>,
    work: impl FnOnce(&RunControl) -> Result<T, EngineError> + Send,
) -> PyResult<T> {
    let nothing = Exchange { take: |_| Ok(()), give: || Ok(None) };
    attended_blocks(py, report, nothing, |watch, _, _| work(watch))
}

/// Runs `work` as `attended`, and exchanges blocks of numbers with it while it goes on. An error of the exchange ends it.
pub fn attended_blocks<T: Send>(
    py: Python<'_>,
    report: Option<Report<'_, '_>>,
    exchange: Exchange<impl FnMut(Vec<f64>) -> PyResult<()>, impl FnMut() -> PyResult<Option<Vec<f64>>>>,
    work: impl FnOnce(&RunControl, Give<'_>, Ask<'_>) -> Result<T, EngineError> + Send,
) -> PyResult<T> {
    let (watch, Exchange { mut take, give }) = (RunControl::default(), exchange);
    // A block is handed over, not kept: one is filled while one is taken.
    let (sender, receiver) = sync_channel(0);
    let receiver = Mutex::new(receiver);
    let (supplier, supplied) = sync_channel(1);
    let mut supply = Supply { give, prepared: None, sender: supplier };
    let mut interruption = None;
    let before = INTERRUPTIONS.load(Ordering::Relaxed);
    let result = std::thread::scope(|scope| {
        let watch = &watch;
        let worker = std::thread::Builder::new().spawn_scoped(scope, move || {
            // Nobody takes or supplies a block of a call that is being stopped.
            let send = |sent| sender.send(sent).map_err(|_| EngineError::Interrupted);
            let ask =
                || send(Sent::Request).and_then(|()| supplied.recv().map_err(|_| EngineError::Interrupted));
            let result = work(watch, &|block| send(Sent::Block(block)), &ask);
            // The receiver lives until the worker ends, unless the call is being stopped.
            let _ = sender.send(Sent::End);
            result
        })?; // the system gives no more threads: an OSError
        let wait =
            || receiver.lock().map_or(Err(RecvTimeoutError::Disconnected), |end| end.recv_timeout(PULSE));
        let mut reported = 0;
        let mut going_on = supply.prepare();
        loop {
            if let Err(error) = going_on {
                watch.stop.store(true, Ordering::Relaxed);
                interruption = Some(error);
                break;
            }
            let sent = py.detach(wait);
            if matches!(sent, Ok(Sent::End) | Err(RecvTimeoutError::Disconnected)) {
                break;
            }
            going_on = require_uninterrupted(py, before)
                .and_then(|()| match sent {
                    Ok(Sent::Block(block)) => take(block),
                    Ok(Sent::Request) => supply.hand_over(),
                    _ => Ok(()),
                })
                .and_then(|()| report_progress(report, watch, &mut reported));
        }
        // A worker that waits with a block, or for one, goes on, and finds that nobody takes or supplies it.
        drop((receiver, supply));
        Ok::<_, PyErr>(py.detach(|| worker.join()))
    })?;
    match (result, interruption) {
        (_, Some(interruption)) => Err(interruption),
        (Ok(Ok(value)), None) => Ok(value),
        (Ok(Err(error)), None) => Err(to_python(&error)),
        (Err(panic), None) => Err(defect(&*panic)),
    }
}

/// The error of a call that is to be stopped: by a signal, or because `interrupt` was called since a number of times.
fn require_uninterrupted(py: Python<'_>, before: usize) -> PyResult<()> {
    py.check_signals()?;
    if INTERRUPTIONS.load(Ordering::Relaxed) == before {
        return Ok(());
    }
    Err(PyKeyboardInterrupt::new_err("interrupted"))
}

/// Reports how many units are done, again and again before the first one, which may take long.
fn report_progress(report: Option<Report<'_, '_>>, watch: &RunControl, reported: &mut usize) -> PyResult<()> {
    let Some((report, done)) = report else { return Ok(()) };
    let done = done(watch);
    if done > 0 && done == *reported {
        return Ok(());
    }
    *reported = done;
    report.call1((done,)).map(drop)
}
