//! The floating-point environment: rounding, flushing of tiny numbers, traps and flags of the processor.
//!
//! Masters have it as they like; results and safety of a slave must not depend on it. While a call runs it is that with
//! which processes start, and the master's own is put aside, flags included. The master's functions run under the
//! master's environment, and what they change in it stays.

use std::cell::Cell;
use std::rc::Rc;

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
mod registers {
    use std::arch::asm;

    /// State of the older unit as `fnstenv` stores it, and the register of the vector unit.
    #[derive(Clone, Copy)]
    #[repr(C)]
    pub struct Environment {
        x87: [u32; 7],
        mxcsr: u32,
    }

    impl Environment {
        /// All traps masked, rounding to nearest, nothing flushed, no flags; the older unit is empty.
        pub const USUAL: Environment =
            Environment { x87: [0xffff_037f, 0xffff_0000, 0xffff_ffff, 0, 0, 0, 0], mxcsr: 0x1f80 };

        /// Makes this the environment of the thread, and returns the one before.
        pub fn exchange(self) -> Environment {
            let mut before = Environment::USUAL;
            // SAFETY: both places are as large as what the instructions store and load: 28 and 4 bytes. The registers
            // of the older unit are empty between functions and stay so. No computation of ours runs under another
            // environment than the usual one: see `Host`.
            unsafe {
                asm!(
                    "fnstenv [{before}]", "stmxcsr [{before} + 28]", "ldmxcsr [{after} + 28]", "fldenv [{after}]",
                    before = in(reg) &raw mut before, after = in(reg) &raw const self,
                );
            }
            before
        }
    }
}

#[cfg(target_arch = "aarch64")]
mod registers {
    use std::arch::asm;

    /// Control and status register.
    #[derive(Clone, Copy)]
    pub struct Environment {
        control: u64,
        status: u64,
    }

    impl Environment {
        /// All traps masked, rounding to nearest, nothing flushed, no flags.
        pub const USUAL: Environment = Environment { control: 0, status: 0 };

        /// Makes this the environment of the thread, and returns the one before.
        pub fn exchange(self) -> Environment {
            let Environment { control, status } = self;
            let mut before = Environment::USUAL;
            // SAFETY: the registers belong to the thread, and programs may read and write them. No computation of ours
            // runs under another environment than the usual one: see `Host`.
            unsafe {
                asm!(
                    "mrs {}, fpcr", "mrs {}, fpsr", "msr fpcr, {}", "msr fpsr, {}",
                    out(reg) before.control, out(reg) before.status, in(reg) control, in(reg) status,
                );
            }
            before
        }
    }
}

#[cfg(not(any(target_arch = "x86", target_arch = "x86_64", target_arch = "aarch64")))]
mod registers {
    /// That of a processor which is not known here stays as it is.
    #[derive(Clone, Copy)]
    pub struct Environment;

    impl Environment {
        /// The only one.
        pub const USUAL: Environment = Environment;

        /// Changes nothing.
        pub fn exchange(self) -> Environment {
            self
        }
    }
}

pub use registers::Environment;

/// The environment of a master, put aside while a call runs.
pub struct Host(Cell<Environment>);

/// Gives the environment back, also after a panic.
struct Returned<'a>(&'a Host);

impl Drop for Returned<'_> {
    fn drop(&mut self) {
        self.0.0.get().exchange();
    }
}

impl Host {
    /// A master that calls for the first time; shared by what it calls and what calls it.
    pub fn new() -> Rc<Host> {
        Rc::new(Host(Cell::new(Environment::USUAL)))
    }

    /// Runs a call of the master under the usual environment.
    #[inline(never)]
    pub fn put_aside<R>(&self, call: impl FnOnce() -> R) -> R {
        self.0.set(Environment::USUAL.exchange());
        let _returned = Returned(self);
        call()
    }

    /// Runs a function of the master, during a call of it, under its own environment.
    #[inline(never)]
    pub fn as_it_was<R>(&self, function: impl FnOnce() -> R) -> R {
        self.0.get().exchange();
        let result = function();
        self.0.set(Environment::USUAL.exchange());
        result
    }
}
