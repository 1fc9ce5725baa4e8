//! What can go wrong with a GPU.

/// Why there is no GPU to draw with, or what it cannot do. The text says what to do.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// No GPU and no software in its place.
    #[error(
        "there is no GPU, nor software in its place: no Vulkan, Metal or Direct3D 12 device was found. \
         Everything but the 3D pictures and `--backend gpu` works without. For those install the driver of the GPU, or Mesa's software Vulkan: \
         `apt-get install mesa-vulkan-drivers` on Debian and Ubuntu, `dnf install mesa-vulkan-drivers` on Fedora"
    )]
    NoDevice,
    /// Every device that was found refused.
    #[error(
        "no graphics device could be opened; the last, {name}, said: {reason}. Update its driver, or install Mesa's software Vulkan (Debian and Ubuntu: mesa-vulkan-drivers)"
    )]
    Refused {
        /// Name of the device tried last.
        name: String,
        /// What it said.
        reason: String,
    },
    /// A picture larger than the device can hold.
    #[error(
        "a picture of {width} x {height} pixels (samples included) is larger than the {most} x {most} that every device can hold; ask for a smaller one"
    )]
    TooLarge {
        /// Width, pixels.
        width: u32,
        /// Height, pixels.
        height: u32,
        /// Largest width and height, pixels.
        most: u32,
    },
    /// More memory in one piece than the device gives.
    #[error(
        "{what} take {} MB, and the graphics device {name} gives {} MB in one piece; take fewer particles or larger cells, or `--backend cpu`",
        bytes.div_ceil(1_000_000), most / 1_000_000
    )]
    Memory {
        /// Name of the device.
        name: String,
        /// What the memory is for.
        what: &'static str,
        /// Requested, bytes.
        bytes: u64,
        /// To be had, bytes.
        most: u64,
    },
    /// More particles or cells than threads.
    #[error(
        "{count} particles or cells are more than the {most} that a graphics device goes through at once; take fewer, or `--backend cpu`"
    )]
    TooMany {
        /// Requested number.
        count: usize,
        /// To be had.
        most: usize,
    },
    /// The device was lost, or gave no answer.
    #[error("the graphics device {name} gave no answer: {reason}")]
    Lost {
        /// Name of the device.
        name: String,
        /// What it said.
        reason: String,
    },
}

/// A shader whose pieces do not fit together.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ImportError {
    /// A piece that is not in the library.
    #[error(
        "line {line} of shader {shader} imports {piece:?}, which is not in the library; add the file to it, or correct the name"
    )]
    Missing {
        /// Name of the shader or piece that imports.
        shader: String,
        /// Line of the import, from 1.
        line: usize,
        /// Name of the piece.
        piece: String,
    },
    /// A shader that is no valid WGSL, or beyond what every device has.
    #[error("shader {shader} is not valid: {reason}")]
    Invalid {
        /// Name of the shader.
        shader: String,
        /// What is wrong with it.
        reason: String,
    },
}
