//! The instruction set that the user forces.

use std::ffi::OsStr;

use softbox::math::Isa;

/// Environment variable that forces an instruction set where no option does.
pub(crate) const VARIABLE: &str = "SOFTBOX_ISA";

/// The instruction set of the `option`, else of the `variable` (empty counts as not set); `None`
/// leaves the choice to the program.
///
/// # Errors
/// One sentence, when the variable holds no instruction set of this processor. The option was
/// checked when it was read.
pub(crate) fn forced(option: Option<Isa>, variable: Option<&OsStr>) -> Result<Option<Isa>, String> {
    let variable = variable.filter(|value| !value.is_empty());
    match (option, variable) {
        (None, Some(value)) => Isa::usable(&value.to_string_lossy())
            .map(Some)
            .map_err(|error| {
                format!("invalid value of the environment variable {VARIABLE}: {error}")
            }),
        _ => Ok(option),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_option_wins_over_the_variable() {
        let forced = |option, variable: &str| forced(option, Some(OsStr::new(variable)));
        assert_eq!(forced(None, "portable"), Ok(Some(Isa::Portable)));
        assert_eq!(forced(None, ""), Ok(None));
        assert_eq!(
            forced(Some(Isa::Portable), "nonsense"),
            Ok(Some(Isa::Portable))
        );
        assert_eq!(super::forced(None, None), Ok(None));
        let error = forced(None, "mmx").unwrap_err();
        assert!(
            error.contains(VARIABLE) && error.contains("'mmx'"),
            "{error}"
        );
    }
}
