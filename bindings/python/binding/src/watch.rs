//! How a call is watched while it takes long, and called off.

use core::fmt;
use core::ops::ControlFlow;
use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// How long a call goes on before its watcher looks whether it is to end.
pub const PATIENCE: Duration = Duration::from_millis(50);

/// How far a call is: steps taken and to take, where they are known.
pub type Far = Option<(u64, u64)>;

/// A function that is told how far a call is, and says whether it goes on.
type Look<'w> = dyn Fn(Far) -> ControlFlow<()> + Sync + 'w;

/// A function of Python that is told the steps taken and to take.
type Told<'t> = dyn Fn(Python<'_>, (u64, u64)) -> PyResult<()> + Sync + 't;

/// A watcher of a call. It is asked as often as one likes, and looks some twenty times a second.
pub struct Watch<'w> {
    look: &'w Look<'w>,
    looked: Mutex<Instant>,
    is_called_off: AtomicBool,
}

impl fmt::Debug for Watch<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Watch").field("is_called_off", &self.is_called_off).finish_non_exhaustive()
    }
}

impl<'w> Watch<'w> {
    /// A watcher that asks `look`.
    #[must_use]
    pub fn new(look: &'w Look<'w>) -> Self {
        Self { look, looked: Mutex::new(Instant::now()), is_called_off: AtomicBool::new(false) }
    }

    /// Tells how far the call is; breaks where it is to end, for ever after.
    pub fn tell(&self, far: Far) -> ControlFlow<()> {
        if self.is_called_off.load(Ordering::Relaxed) || (self.look)(far).is_break() {
            self.is_called_off.store(true, Ordering::Relaxed);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// As [`tell`](Self::tell), when it is time to.
    pub fn pass(&self, far: Far) -> ControlFlow<()> {
        let is_time = {
            let mut looked = self.looked.lock().unwrap_or_else(PoisonError::into_inner);
            let is_time = looked.elapsed() > PATIENCE;
            if is_time {
                *looked = Instant::now();
            }
            is_time
        };
        if is_time {
            self.tell(far)
        } else if self.is_called_off.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Whether to end, for a [`Stop`](dalembert::run::Stop).
    #[must_use]
    pub fn is_called_off(&self) -> bool {
        self.pass(None).is_break()
    }
}

/// Does `work` without the interpreter's lock; Ctrl-C calls it off, and so does `told`, which is told how far
/// it is. Returns its result, with the exception that has called it off.
pub fn watched<T: Send>(
    py: Python<'_>,
    told: &Told<'_>,
    work: impl FnOnce(&Watch<'_>) -> T + Send,
) -> (T, Option<PyErr>) {
    let raised = Mutex::new(None);
    let look = |far: Far| {
        let looked = Python::attach(|py| {
            py.check_signals()?;
            far.map_or(Ok(()), |far| told(py, far))
        });
        looked.map_or_else(
            |error| {
                raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                ControlFlow::Break(())
            },
            ControlFlow::Continue,
        )
    };
    let result = py.detach(|| work(&Watch::new(&look)));
    (result, raised.into_inner().unwrap_or_else(PoisonError::into_inner))
}
