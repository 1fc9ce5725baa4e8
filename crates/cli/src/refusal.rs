//! Errors caused by the input.

use corpuscle_ensemble::EnsembleError;
use corpuscle_export::ExportError;
use std::fmt;

/// An error of the input: exit status 2.
#[derive(Debug)]
struct Refusal(String);

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Refusal {}

/// Makes an error of the input from its message.
pub fn refuse(what: impl Into<String>) -> anyhow::Error {
    Refusal(what.into()).into()
}

/// True for an error of the input.
pub fn is_refusal(error: &anyhow::Error) -> bool {
    error.is::<Refusal>()
        || error.downcast_ref::<corpuscle::Error>().is_some_and(corpuscle::Error::is_refusal)
        || error.downcast_ref::<EnsembleError>().is_some_and(EnsembleError::is_refusal)
        || error.downcast_ref::<ExportError>().is_some_and(ExportError::is_refusal)
}

/// The error with its causes as one paragraph; a cause whose text the message already has is left out.
pub fn in_words(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |message, cause| match message.as_str() {
        "" => cause,
        so_far if so_far.contains(&cause) => message,
        so_far => format!("{so_far}: {cause}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn causes_are_written_once() {
        let error = Err::<(), _>(std::io::Error::other("disk is full"));
        let error = error.context("cannot write a.csv: disk is full").context("the run ended").unwrap_err();
        assert_eq!(in_words(&error), "the run ended: cannot write a.csv: disk is full");
    }
}
