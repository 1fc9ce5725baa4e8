//! Balls of particles in GPU memory.

use super::{BallPainter, BallStyle, Balls};
use crate::shared::{BallInstance, Bound};
use crate::{RenderError, Stage};
use corpuscle_gpu::{DeviceParticles, Gpu, Kernel, THREADS, storage, submit, uniform};
use glam::DVec3;

/// Settings of balls of particles in GPU memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallsOfDevice {
    /// Radius over the particles' distance.
    pub radius: f64,
    /// How many times higher than they are heights are drawn.
    pub raise: f64,
    /// The number that a ball's colour shows.
    pub value: ValueOfDevice,
}

/// A number of a particle on the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueOfDevice {
    /// Depth of the water, m.
    Depth,
    /// Temperature of the air, degrees Celsius.
    Temperature,
}

corpuscle_gpu::declare! {
    include [Bound]
    constants {
        /// Threads of a group.
        const GROUP: u32 = THREADS;
        /// The number that shows is the depth of water.
        const DEPTH: u32 = 0;
        /// It is the temperature of air.
        const TEMPERATURE: u32 = 1;
    }
    structs {
        /// How balls are made.
        struct Settings {
            /// From the origin of the particles to the middle of the stage, m, heights raised.
            shift: [f32; 3],
            /// How many times higher than they are heights are drawn.
            raise: f32,
            /// Length of a stage unit, m.
            unit: f32,
            /// Radius over the distance of particles.
            radius: f32,
            /// The number that shows: [`DEPTH`] or [`TEMPERATURE`].
            value: u32,
            /// Particles that there is room for.
            room: u32,
        }
    }

    /// What makes balls of particles works on.
    pub(super) buffers Memory {
        /// How they are made.
        uniform settings: Settings,
        /// The particles.
        storage particles: DeviceParticles,
        /// The balls.
        storage balls: [BallInstance],
    }
}

/// What makes balls of particles on the device.
fn maker(gpu: &Gpu) -> Kernel<Memory> {
    Kernel::new(gpu, "balls_device", include_str!("balls_device.wgsl"), &[])
}

impl BallPainter {
    /// Balls of particles as they stand on the device now, without a copy to the host.
    ///
    /// # Errors
    /// [`RenderError::Gpu`] for more particles than there is room for.
    pub fn balls_of_device(
        &self,
        gpu: &Gpu,
        stage: &Stage,
        style: &BallStyle,
        particles: &DeviceParticles,
        shows: BallsOfDevice,
    ) -> Result<Balls, RenderError> {
        let BallsOfDevice { radius, raise, value } = shows;
        let raised = |position: [f64; 3]| DVec3::new(position[0], position[1], raise * position[2]);
        let settings = Settings {
            shift: (raised(particles.origin) - stage.centre()).as_vec3().into(),
            raise: raise as f32,
            unit: stage.unit() as f32,
            radius: radius as f32,
            value: match value {
                ValueOfDevice::Depth => DEPTH,
                ValueOfDevice::Temperature => TEMPERATURE,
            },
            room: particles.room as u32,
        };
        let memory = Memory {
            settings: uniform(gpu, "balls of the device", &settings),
            particles: particles.buffer.clone(),
            balls: storage::<BallInstance>(gpu, "balls of the device", particles.room)?,
        };
        let task = self.maker.get_or_init(|| maker(gpu)).on(gpu, &memory);
        submit(gpu, "balls", None, |pass| task.run(pass, (particles.room as u32).div_ceil(THREADS)));
        Ok(self.balls_in(gpu, style, [(&memory.balls, particles.room as u32)]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Camera, ColourTable, Drawable, Light, Renderer, Shading, Target};
    use corpuscle_gpu::{Buffers, DeviceParticle, check_layouts, check_shader, require_gpu};

    #[test]
    fn the_shader_is_valid_and_within_the_floor() {
        let text = include_str!("balls_device.wgsl");
        let (text, _) = Memory::declaration().complete("balls_device", text, &[]).unwrap();
        check_shader(&text).unwrap();
        check_layouts(&Memory::declaration()).unwrap();
    }

    #[test]
    fn balls_of_the_device_are_those_of_the_host() {
        let Some(gpu) = require_gpu("balls on the device") else { return };
        let renderer = Renderer::new(&gpu);
        let painter = BallPainter::new(&renderer);
        let (corner, raise) = ([6e5, 5e6, 300.0], 3.0);
        let stage = Stage::new([6e5, 5e6, 900.0], [6e5 + 9.0, 5e6 + 9.0, 915.0]);
        let colours = ColourTable { low: 0.0, high: 30.0, colours: vec![[0, 0, 255], [255, 0, 0]] };
        let mut all: Vec<DeviceParticle> = (0..300_u32)
            .map(|id| DeviceParticle {
                position: [(id % 10) as f32, (id / 10 % 10) as f32, (id / 100) as f32],
                spacing: 0.6 + 0.001 * id as f32,
                depth: 0.1 * id as f32,
                temperature: 30.0 - 0.1 * id as f32,
                volume: 1.0,
                id,
                ..DeviceParticle::default()
            })
            .collect();
        // Some are none.
        all.iter_mut().step_by(7).for_each(|particle| particle.volume = 0.0);
        let particles = DeviceParticles::new(&gpu, 500, corner, 1.0).unwrap();
        particles.write(&gpu, &all);
        let camera = Camera::orbit(&stage, [0.4, 0.5], 0.5, 1.0, 0.1);
        let target = Target::new(&gpu, [200, 200], 1).unwrap();
        for (value, shading) in [(ValueOfDevice::Depth, Shading::Matt), (ValueOfDevice::Temperature, Shading::Full)] {
            let style = BallStyle { shading, ..BallStyle::new(colours.clone()) };
            let shows = BallsOfDevice { radius: 0.5, raise, value };
            let mut of_device = painter.balls_of_device(&gpu, &stage, &style, &particles, shows).unwrap();
            let there = all.iter().filter(|particle| particle.volume > 0.0);
            let balls = there.map(|particle| {
                let position: [f64; 3] = std::array::from_fn(|axis| corner[axis] + f64::from(particle.position[axis]));
                let number = if value == ValueOfDevice::Depth { particle.depth } else { particle.temperature };
                ([position[0], position[1], raise * position[2]], 0.5 * f64::from(particle.spacing), f64::from(number))
            });
            let mut of_host = painter.balls(&gpu, &stage, &style, balls);
            let picture = |thing: Option<&mut dyn Drawable>| {
                let mut things: Vec<&mut dyn Drawable> = thing.into_iter().collect();
                renderer.draw(&target, &stage, &camera, &Light::studio(), &mut things, None);
                renderer.read(&target).unwrap().rgba
            };
            let [one, other, none] = [picture(Some(&mut of_device)), picture(Some(&mut of_host)), picture(None)];
            let off = one.iter().zip(&other).filter(|(one, other)| one.abs_diff(**other) > 2).count();
            let drawn = other.iter().zip(&none).filter(|(one, other)| one.abs_diff(**other) > 2).count();
            assert!(drawn > 10_000 && off * 1000 < drawn, "{off} of {drawn} differ");
        }
    }
}
