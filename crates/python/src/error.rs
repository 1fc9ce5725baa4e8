//! Errors as exceptions of Python.

use corpuscle::Error;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The exception of an error: `corpuscle.SceneError` where the input was refused, `corpuscle.RunError` where an accepted run failed.
pub fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let class = if error.is_refusal() { "SceneError" } else { "RunError" };
    raise(py, class, &error.to_string(), location(error)).unwrap_or_else(|failed| failed)
}

/// A `corpuscle.RunError` with a message.
pub fn run_error(py: Python<'_>, message: &str) -> PyErr {
    raise(py, "RunError", message, None).unwrap_or_else(|failed| failed)
}

/// A `corpuscle.SceneError` with a message.
pub fn scene_error(py: Python<'_>, message: &str) -> PyErr {
    raise(py, "SceneError", message, None).unwrap_or_else(|failed| failed)
}

/// The key and the line of a scene that an error names.
fn location(error: &Error) -> Option<(String, Option<usize>)> {
    let Error::Scene(error) = error else { return None };
    let problem = error.problem()?;
    Some((problem.key.clone(), problem.location.as_ref().and_then(|location| location.line)))
}

fn raise(py: Python<'_>, class: &str, message: &str, location: Option<(String, Option<usize>)>) -> PyResult<PyErr> {
    let class = py.import("corpuscle._errors")?.getattr(class)?;
    let named = PyDict::new(py);
    if let Some((key, line)) = location {
        named.set_item("key", key)?;
        named.set_item("line", line)?;
    }
    let made = class.call((message,), Some(&named))?;
    Ok(PyErr::from_value(made))
}

/// The exception of a thread that panicked.
pub fn panicked(cause: &(dyn std::any::Any + Send)) -> PyErr {
    let text = cause.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| cause.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into());
    PyRuntimeError::new_err(format!(
        "the program failed by a mistake of its own: {text}; please report it with the scene"
    ))
}
