//! Work on several cores.

use std::sync::Mutex;
use std::thread;

use anyhow::Result;

/// Does the work for each item, several beside each other, and returns what comes of it in no order.
pub fn each<T: Send, R: Send>(items: Vec<T>, work: impl Fn(T) -> Result<R> + Sync) -> Result<Vec<R>> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let left = Mutex::new(items.into_iter());
    let next = || left.lock().expect("no work panics here").next();
    let worker = || -> Result<Vec<R>> {
        let mut done = Vec::new();
        while let Some(item) = next() {
            done.push(work(item)?);
        }
        Ok(done)
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(worker)).collect();
        let mut done = Vec::new();
        for worker in workers {
            done.extend(worker.join().expect("no work panics")?);
        }
        Ok(done)
    })
}

#[cfg(test)]
mod tests {
    use anyhow::ensure;

    use super::each;

    #[test]
    fn all_is_done_or_an_error_comes_out() {
        let mut squares = each((0..100).collect(), |item: u32| Ok(item * item)).unwrap();
        squares.sort_unstable();
        assert_eq!(squares, (0..100).map(|item| item * item).collect::<Vec<_>>());
        assert!(
            each(vec![1, 2, 3], |item| {
                ensure!(item != 2);
                Ok(item)
            })
            .is_err()
        );
    }
}
