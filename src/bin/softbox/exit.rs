use std::process::ExitCode;

/// How the program ends; scripts rely on the numbers. Usage errors (2) end in the parser.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    /// Something went wrong while running.
    Failed = 1,
    /// What was asked for makes no sense.
    Usage = 2,
    /// The scene cannot be read.
    Scene = 3,
    /// An output cannot be written.
    Output = 4,
    /// Ctrl+C, after writing what there is.
    Interrupted = 130,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status as u8)
    }
}

/// An error with the status to end with.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) status: Status,
    pub(crate) error: anyhow::Error,
}

impl Status {
    /// For `map_err`: the error with this status.
    pub(crate) fn because<E: Into<anyhow::Error>>(self) -> impl FnOnce(E) -> Failure {
        move |error| Failure {
            status: self,
            error: error.into(),
        }
    }
}
