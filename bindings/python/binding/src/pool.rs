//! Threads of ensembles.

use std::mem::forget;
use std::num::NonZeroUsize;
use std::process;
use std::sync::{Arc, Mutex};
use std::thread::available_parallelism;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Threads, and the process that has started them: they are not there in one that was forked from it.
struct Started {
    by: u32,
    pool: Arc<ThreadPool>,
}

static STARTED: Mutex<Option<Started>> = Mutex::new(None);

/// The threads of an ensemble: as many as asked for, but no more than the machine has cores; one a core
/// unless said, and these are kept for the next.
///
/// # Errors
/// `ValueError` where no thread is asked for, `RuntimeError` where they cannot be started.
pub fn of(_: Python<'_>, threads: Option<usize>) -> PyResult<Arc<ThreadPool>> {
    match threads {
        None => kept(),
        Some(0) => {
            Err(PyValueError::new_err("threads: expected at least 1, got 0; leave it out for one a core"))
        }
        Some(threads) => {
            let cores = available_parallelism().map_or(threads, NonZeroUsize::get);
            start(ThreadPoolBuilder::new().num_threads(threads.min(cores)))
        }
    }
}

/// The threads of this process.
fn kept() -> PyResult<Arc<ThreadPool>> {
    // Another thread is here now, or was when this process was forked from its own, and is not waited for.
    let Ok(mut started) = STARTED.try_lock() else { return start(ThreadPoolBuilder::new()) };
    let process = process::id();
    if let Some(Started { by, pool }) = &*started
        && *by == process
    {
        return Ok(Arc::clone(pool));
    }
    let pool = start(ThreadPoolBuilder::new())?;
    // Those of the process that this one was forked from cannot be told to end: they are not here.
    forget(started.replace(Started { by: process, pool: Arc::clone(&pool) }));
    Ok(pool)
}

fn start(threads: ThreadPoolBuilder) -> PyResult<Arc<ThreadPool>> {
    let pool = threads.thread_name(|number| format!("dalembert-{number}")).build();
    pool.map(Arc::new).map_err(|error| {
        PyRuntimeError::new_err(format!(
            "threads: they cannot be started: {error}; ask for fewer, or raise the limit"
        ))
    })
}
