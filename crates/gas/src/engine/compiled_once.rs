//! Methods that are compiled in this crate alone.

/// Calls a method of `Engine<D>` in a function for two or for three dimensions that is not generic. What is generic is compiled again in each
/// crate that uses it, and the loops over events, in six modes for three kinds of processors, are half of what there is to compile of this crate.
macro_rules! compiled_once {
    ($engine:ident.$method:ident($($argument:ident: $kind:ty),*) $(-> $result:ty)?) => {{
        fn in_two_dimensions(engine: &mut Engine<2>, $($argument: $kind),*) $(-> $result)? {
            engine.$method($($argument),*)
        }
        fn in_three_dimensions(engine: &mut Engine<3>, $($argument: $kind),*) $(-> $result)? {
            engine.$method($($argument),*)
        }
        let engine: &mut dyn std::any::Any = $engine;
        if let Some(engine) = engine.downcast_mut() {
            in_two_dimensions(engine, $($argument),*)
        } else if let Some(engine) = engine.downcast_mut() {
            in_three_dimensions(engine, $($argument),*)
        } else {
            unreachable!("a gas has two or three dimensions")
        }
    }};
}
pub(super) use compiled_once;
