//! Ground that was under water stays darker until it has dried: when each position was last under water, and how high the water stood, from picture
//! to picture.

use crate::shared::WetGround as Parameters;
use crate::{RenderError, Stage};
use corpuscle_gpu::{Gpu, storage, wgpu};

/// Most cells of the grid: 8 MiB for each of its two numbers.
const MOST_CELLS: f64 = 2.0 * 1024.0 * 1024.0;

/// When ground was last under water, on a grid over the stage.
#[derive(Debug)]
pub(super) struct WetGround {
    parameters: Parameters,
    uniforms: wgpu::Buffer,
    /// Time at which each cell was last under water, as the bits of a number of single precision above 0; 0: never.
    latest: wgpu::Buffer,
    /// How high the water stood there at most: see wet_ground.wgsl.
    levels: wgpu::Buffer,
    /// Time of the first picture and of the last, s; none before.
    times: Option<[f64; 2]>,
}

impl WetGround {
    /// A record in cells of a width, m, or wider ones where there would be too many. Ground is soaked this far above the water, m, and loses all but
    /// 1 / e of its darkness in the time `drying`, s.
    pub fn new(gpu: &Gpu, stage: &Stage, width: f64, soaked: f64, drying: f64) -> Result<Self, RenderError> {
        let size = (stage.to - stage.from).truncate();
        let width = width.max((size.x * size.y / MOST_CELLS).sqrt()).max(size.max_element() / MOST_CELLS);
        let cells = (size / width).ceil().max(glam::DVec2::ONE).as_uvec2();
        let number = cells.x as usize * cells.y as usize;
        let parameters = Parameters {
            corner: stage.position(stage.from.into()).truncate().into(),
            per_unit: 1.0 / stage.length(width),
            soaked: stage.length(soaked),
            cells: cells.into(),
            now: 0.0,
            drying: (1.0 / drying) as f32,
        };
        Ok(Self {
            parameters,
            uniforms: crate::buffer::uniform(gpu, "wet ground", &parameters),
            latest: storage::<u32>(gpu, "latest time under water", number)?,
            levels: storage::<u32>(gpu, "levels of water", number)?,
            times: None,
        })
    }

    /// What shaders with `#import wet_ground` and the record of it have bound.
    pub fn bindings(&self) -> [(&'static str, wgpu::BindingResource<'_>); 3] {
        [
            ("wet", self.uniforms.as_entire_binding()),
            ("wet_latest", self.latest.as_entire_binding()),
            ("wet_levels", self.levels.as_entire_binding()),
        ]
    }

    /// Sets the time of the picture, s. One before that of the last picture begins anew.
    pub fn set_time(&mut self, gpu: &Gpu, time: f64) {
        let first = match self.times {
            Some([first, last]) if time >= last => first,
            Some(_) => {
                self.forget(gpu);
                time
            }
            None => time,
        };
        self.times = Some([first, time]);
        // Above 0, which stands for never.
        self.parameters.now = (1.0 + time - first) as f32;
        gpu.queue.write_buffer(&self.uniforms, 0, bytemuck::bytes_of(&self.parameters));
    }

    fn forget(&self, gpu: &Gpu) {
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("wet ground") });
        encoder.clear_buffer(&self.latest, 0, None);
        encoder.clear_buffer(&self.levels, 0, None);
        gpu.queue.submit([encoder.finish()]);
    }
}
