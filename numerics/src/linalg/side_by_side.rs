//! Parts of a computation on threads of their own.

use std::{iter, panic, thread};

/// Results of two computations at the same time: `own` on this thread, `other` on one of its own, or on this one if the
/// system grants none.
pub fn join<A, B: Send>(own: impl FnOnce() -> A, other: impl Fn() -> B + Sync) -> (A, B) {
    thread::scope(|scope| {
        let elsewhere = thread::Builder::new().spawn_scoped(scope, &other);
        let own = own();
        let other = match elsewhere {
            Ok(thread) => thread.join().unwrap_or_else(|panic| panic::resume_unwind(panic)),
            Err(_) => other(),
        };
        (own, other)
    })
}

/// Results of `work` for the numbers below `count`, in their order, all at the same time.
pub fn side_by_side<R: Send>(count: usize, work: impl Fn(usize) -> R + Sync) -> Vec<R> {
    fn from<R: Send>(first: usize, count: usize, work: &(impl Fn(usize) -> R + Sync)) -> Vec<R> {
        match count - first {
            0 => Vec::new(),
            1 => vec![work(first)],
            _ => {
                let (own, others) = join(|| work(first), || from(first + 1, count, work));
                iter::once(own).chain(others).collect()
            }
        }
    }
    from(0, count, &work)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_come_in_the_order_of_their_numbers() {
        assert_eq!(side_by_side(5, |k| k * k), [0, 1, 4, 9, 16]);
        assert!(side_by_side(0, |k| k).is_empty());
        assert_eq!(join(|| 7, || "other"), (7, "other"));
    }

    #[test]
    fn a_panic_comes_through() {
        assert!(panic::catch_unwind(|| join(|| 0, || -> u8 { panic!("elsewhere") })).is_err());
    }
}
