//! Errors as exceptions.

use crate::Diagnostic;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(
    rungc,
    RungcError,
    PyException,
    "A program or its settings cannot be read."
);
create_exception!(
    rungc,
    Rejected,
    RungcError,
    "A program has errors, which are its argument."
);
create_exception!(
    rungc,
    DeviceError,
    RungcError,
    "A name is that of no device, or a value does not fit the device."
);

/// The exception for an error of the library.
pub(crate) fn raised(error: rungc::Error) -> PyErr {
    match error {
        rungc::Error::Rejected(errors) => {
            let errors: Vec<Diagnostic> = errors.into_iter().map(Diagnostic).collect();
            Rejected::new_err((errors,))
        }
        rungc::Error::Device(why) => DeviceError::new_err(why),
        error => RungcError::new_err(error.to_string()),
    }
}
