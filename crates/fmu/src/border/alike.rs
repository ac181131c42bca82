//! Functions whose arguments are the same in both versions of the standard.
//!
//! The module of a version gives the names that they have there, and its type `Log`.

/// Functions that do the same in both versions.
macro_rules! both {
    (
        $free:ident, $exit_initialization:ident, $terminate:ident, $reset:ident,
        $keep:ident, $restore:ident, $forget:ident,
        $size:ident, $write:ident, $read:ident
    ) => {
        /// Gives an instance back.
        #[unsafe(no_mangle)]
        extern "C" fn $free(instance: *mut c_void) {
            calls::free::<Log>(instance);
        }

        /// The start is set.
        #[unsafe(no_mangle)]
        extern "C" fn $exit_initialization(instance: *mut c_void) -> Status {
            call::<Log>(instance, |instance| instance.unit.exit_initialization())
        }

        /// Ends a run.
        #[unsafe(no_mangle)]
        extern "C" fn $terminate(instance: *mut c_void) -> Status {
            calls::terminate::<Log>(instance)
        }

        /// Back to the start values.
        #[unsafe(no_mangle)]
        extern "C" fn $reset(instance: *mut c_void) -> Status {
            call::<Log>(instance, |instance| {
                instance.unit.reset();
                Ok(())
            })
        }

        /// Keeps the present state.
        #[unsafe(no_mangle)]
        extern "C" fn $keep(instance: *mut c_void, state: *mut *mut c_void) -> Status {
            calls::keep_state::<Log>(instance, state)
        }

        /// Goes back to a state.
        #[unsafe(no_mangle)]
        extern "C" fn $restore(instance: *mut c_void, state: *mut c_void) -> Status {
            calls::restore_state::<Log>(instance, state)
        }

        /// Forgets a state.
        #[unsafe(no_mangle)]
        extern "C" fn $forget(instance: *mut c_void, state: *mut *mut c_void) -> Status {
            calls::free_state::<Log>(instance, state)
        }

        /// Says how many bytes a state has.
        #[unsafe(no_mangle)]
        extern "C" fn $size(instance: *mut c_void, state: *mut c_void, size: *mut usize) -> Status {
            calls::state_size::<Log>(instance, state, size)
        }

        /// Writes a state as bytes.
        #[unsafe(no_mangle)]
        extern "C" fn $write(
            instance: *mut c_void,
            state: *mut c_void,
            bytes: *mut u8,
            size: usize,
        ) -> Status {
            calls::write_state::<Log>(instance, state, bytes, size)
        }

        /// Reads a state from bytes.
        #[unsafe(no_mangle)]
        extern "C" fn $read(
            instance: *mut c_void,
            bytes: *const u8,
            size: usize,
            state: *mut *mut c_void,
        ) -> Status {
            calls::read_state::<Log>(instance, (bytes, size), state)
        }
    };
}
pub(super) use both;

/// Functions for variables of types that this unit does not have: no variable is no mistake.
macro_rules! of_another_type {
    ($($name:ident($($argument:ty),*);)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void, _: *const u32, count: usize, $(_: $argument),*) -> Status {
                calls::no_variables::<Log>(instance, stringify!($name), count)
            }
        )*
    };
}
pub(super) use of_another_type;

/// Functions of the standard that this unit does not have: it has no events, no derivatives and no structural parameters.
macro_rules! without {
    ($($name:ident($($argument:ty),*);)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name(instance: *mut c_void, $(_: $argument),*) -> Status {
                calls::unsupported::<Log>(instance, stringify!($name))
            }
        )*
    };
}
pub(super) use without;
