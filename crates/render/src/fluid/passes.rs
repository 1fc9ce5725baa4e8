//! The passes, one by one.

use super::droplet::Batch;
use super::layers::{Layers, whole};
use super::painter::Filter;
use super::{Fluid, Smoothing};
use crate::Through;
use crate::shared::{PIXELS_ACROSS, PIXELS_DOWN};
use corpuscle_gpu::wgpu;
use wgpu::BindingResource::{Sampler, TextureView};

/// A pass of a fluid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum FluidPass {
    /// The nearest surface of the particles.
    Depth,
    /// How much water is in a line of sight, and foam.
    Thickness,
    /// The filter of depth.
    Smoothing,
    /// Normals from depth.
    Normals,
    /// Which ground is under water.
    Wetting,
    /// Colours.
    Shading,
    /// Into the picture, and ground that is still wet.
    Composing,
}

impl FluidPass {
    /// All, in their order.
    pub const ALL: [Self; 7] =
        [Self::Depth, Self::Thickness, Self::Smoothing, Self::Normals, Self::Wetting, Self::Shading, Self::Composing];
}

impl Fluid {
    /// Encodes a pass.
    pub(super) fn encode(&self, pass: FluidPass, layers: &Layers, frame: &mut Through<'_>) {
        match pass {
            FluidPass::Depth => self.draw_depth(layers, frame),
            FluidPass::Thickness => self.draw_thickness(layers, frame),
            FluidPass::Smoothing => self.smooth(layers, frame),
            FluidPass::Normals => self.find_normals(layers, frame),
            FluidPass::Wetting => self.wet(frame),
            FluidPass::Shading => self.shade(layers, frame),
            FluidPass::Composing => self.compose(layers, frame),
        }
    }

    fn draw_depth(&self, layers: &Layers, frame: &mut Through<'_>) {
        let painter = &self.painter;
        if let Some(splats) = self.splats(layers) {
            self.splat_into(("nearest", &splats.nearest), &painter.splat_depth, frame);
            let into = [("distances", &layers.distances[0])];
            return finish(&painter.splat_nearest, ("nearest", &splats.nearest), &into, frame);
        }
        let depth = whole(&layers.nearest);
        let far = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard };
        let depth = wgpu::RenderPassDepthStencilAttachment { view: &depth, depth_ops: Some(far), stencil_ops: None };
        self.draw_sprites(frame, &[&layers.distances[0]], Some(depth), &self.painter.depth);
    }

    fn draw_thickness(&self, layers: &Layers, frame: &mut Through<'_>) {
        let painter = &self.painter;
        if let Some(splats) = self.splats(layers) {
            self.splat_into(("sums", &splats.sums), &painter.splat_thickness, frame);
            let into = [("thickness", &layers.thickness), ("flow", &layers.flow)];
            return finish(&painter.splat_added, ("sums", &splats.sums), &into, frame);
        }
        self.draw_sprites(frame, &[&layers.thickness, &layers.flow], None, &self.painter.thickness);
    }

    /// Draws particles by a compute shader into numbers that are cleared before.
    fn splat_into(&self, (name, numbers): (&str, &wgpu::Buffer), splat: &Filter, frame: &mut Through<'_>) {
        frame.encoder.clear_buffer(numbers, 0, None);
        let bound = [("fluid", self.settings.as_entire_binding()), (name, numbers.as_entire_binding())];
        self.run_over_particles(splat, &bound, frame);
    }

    /// Runs a compute shader over all particles; they and their number are bound beside `bound`.
    fn run_over_particles(
        &self,
        filter: &Filter,
        bound: &[(&str, wgpu::BindingResource<'_>)],
        frame: &mut Through<'_>,
    ) {
        let of_batch = |batch: &Batch| {
            let [droplets, draw_args] = batch.buffers().map(wgpu::Buffer::as_entire_binding);
            let bound = [&[("droplets", droplets), ("draw_args", draw_args)], bound].concat();
            filter.layout.bind(&frame.gpu.device, &bound)
        };
        let groups: Vec<_> = self.droplets.iter().map(of_batch).collect();
        let mut pass = frame.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&filter.pipeline);
        pass.set_bind_group(0, frame.view, &[]);
        for (batch, group) in self.droplets.iter().zip(&groups) {
            pass.set_bind_group(1, group, &[]);
            batch.splat(&mut pass);
        }
    }

    fn draw_sprites(
        &self,
        frame: &mut Through<'_>,
        into: &[&wgpu::Texture],
        depth: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
        pipeline: &wgpu::RenderPipeline,
    ) {
        let settings = self.settings.as_entire_binding();
        let settings = self.painter.settings.bind(&frame.gpu.device, &[("fluid", settings)]);
        let nothing =
            wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
        let views: Vec<_> = into.iter().map(|texture| whole(texture)).collect();
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops: nothing })
        };
        let attachments: Vec<_> = views.iter().map(attachment).collect();
        let mut pass = frame.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("particles"),
            color_attachments: &attachments,
            depth_stencil_attachment: depth,
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_bind_group(0, frame.view, &[]);
        pass.set_bind_group(1, &settings, &[]);
        pass.set_pipeline(pipeline);
        self.droplets.iter().for_each(|batch| batch.draw(&mut pass));
    }

    fn smooth(&self, layers: &Layers, frame: &mut Through<'_>) {
        let painter = &self.painter;
        match self.style.smoothing {
            Smoothing::None => (),
            Smoothing::Bilateral(times) => {
                for _ in 0..times {
                    self.filter(&painter.bilateral, layers, [0, 1], &self.along_rows, frame);
                    self.filter(&painter.bilateral, layers, [1, 0], &self.along_columns, frame);
                }
            }
            Smoothing::NarrowRange => {
                self.filter(&painter.narrow_range, layers, [0, 1], &self.along_rows, frame);
                self.filter(&painter.narrow_range, layers, [1, 0], &self.along_columns, frame);
                self.filter(&painter.square, layers, [0, 1], &self.along_rows, frame);
            }
        }
    }

    /// The picture of distances that smoothing leaves behind.
    pub(super) fn surface<'a>(&self, layers: &'a Layers) -> &'a wgpu::Texture {
        &layers.distances[usize::from(self.style.smoothing == Smoothing::NarrowRange)]
    }

    fn filter(
        &self,
        filter: &Filter,
        layers: &Layers,
        [from, to]: [usize; 2],
        direction: &wgpu::Buffer,
        frame: &mut Through<'_>,
    ) {
        let [from, to] = [from, to].map(|index| whole(&layers.distances[index]));
        let bound = [
            ("fluid", self.settings.as_entire_binding()),
            ("distances", TextureView(&from)),
            ("smoothed", TextureView(&to)),
            ("direction", direction.as_entire_binding()),
        ];
        run(filter, &bound, layers.size, frame);
    }

    fn find_normals(&self, layers: &Layers, frame: &mut Through<'_>) {
        let [from, to] = [self.surface(layers), &layers.normals].map(whole);
        let bound = [
            ("fluid", self.settings.as_entire_binding()),
            ("distances", TextureView(&from)),
            ("normals", TextureView(&to)),
        ];
        run(&self.painter.normals, &bound, layers.size, frame);
    }

    /// Notes where there is water.
    fn wet(&self, frame: &mut Through<'_>) {
        self.run_over_particles(&self.painter.wet_mark, &self.wet_ground.bindings(), frame);
    }

    fn shade(&self, layers: &Layers, frame: &mut Through<'_>) {
        let read = [self.surface(layers), &layers.normals, &layers.thickness, &layers.flow].map(whole);
        let [distances, normals, thickness, flow] = read.each_ref().map(TextureView);
        let shaded = whole(&layers.shaded);
        let mut bound = vec![
            ("fluid", self.settings.as_entire_binding()),
            ("distances", distances),
            ("normals", normals),
            ("thickness", thickness),
            ("flow", flow),
            ("behind_colour", TextureView(frame.behind_colour)),
            ("behind_depth", TextureView(frame.behind_depth)),
            ("linear", Sampler(&self.painter.sampler)),
            ("shaded", TextureView(&shaded)),
        ];
        bound.extend(self.wet_ground.bindings());
        run(&self.painter.shading, &bound, layers.size, frame);
    }

    fn compose(&self, layers: &Layers, frame: &mut Through<'_>) {
        let [distances, shaded] = [self.surface(layers), &layers.shaded].map(whole);
        let mut bound = vec![
            ("fluid", self.settings.as_entire_binding()),
            ("distances", TextureView(&distances)),
            ("shaded", TextureView(&shaded)),
            ("behind_colour", TextureView(frame.behind_colour)),
            ("behind_depth", TextureView(frame.behind_depth)),
        ];
        bound.extend(self.wet_ground.bindings());
        let group = self.painter.composed.bind(&frame.gpu.device, &bound);
        let mut pass = frame.begin("composing");
        pass.set_pipeline(&self.painter.composing);
        pass.set_bind_group(1, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Makes textures of one size of what was splatted.
fn finish(
    filter: &Filter,
    (name, numbers): (&str, &wgpu::Buffer),
    into: &[(&str, &wgpu::Texture)],
    frame: &mut Through<'_>,
) {
    let views: Vec<_> = into.iter().map(|(name, texture)| (*name, whole(texture))).collect();
    let mut bound = vec![(name, numbers.as_entire_binding())];
    bound.extend(views.iter().map(|(name, view)| (*name, TextureView(view))));
    let texture = into[0].1;
    run(filter, &bound, [texture.width(), texture.height()], frame);
}

/// Runs a filter over all pixels.
fn run(filter: &Filter, bound: &[(&str, wgpu::BindingResource<'_>)], size: [u32; 2], frame: &mut Through<'_>) {
    let group = filter.layout.bind(&frame.gpu.device, bound);
    let mut pass = frame.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
    pass.set_pipeline(&filter.pipeline);
    pass.set_bind_group(0, frame.view, &[]);
    pass.set_bind_group(1, &group, &[]);
    pass.dispatch_workgroups(size[0].div_ceil(PIXELS_ACROSS), size[1].div_ceil(PIXELS_DOWN), 1);
}
