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

impl Failure {
    /// The error and its causes in one line. Many errors tell their cause themselves; it is not told
    /// twice.
    pub(crate) fn message(&self) -> String {
        let mut text = String::new();
        for cause in self.error.chain().map(ToString::to_string) {
            if text.is_empty() {
                text = cause;
            } else if !text.contains(&cause) {
                text = format!("{}: {cause}", text.trim_end_matches('.'));
            }
        }
        text
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::anyhow;

    #[test]
    fn causes_are_told_once() {
        let told = |error: anyhow::Error| Status::Failed.because()(error).message();
        let cause = || anyhow!("disk full");
        assert_eq!(told(cause()), "disk full");
        assert_eq!(
            told(cause().context("Cannot write.")),
            "Cannot write: disk full"
        );
        let own = cause().context("Cannot write: disk full.");
        assert_eq!(told(own), "Cannot write: disk full.");
    }
}
