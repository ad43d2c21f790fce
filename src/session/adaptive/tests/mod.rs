//! Tests F4 to F6 of the stress list, and who gets the samples of least error.

mod allotment;
mod coverage;
mod synthetic;
