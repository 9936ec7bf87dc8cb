//! Texels that look-ups, fetches and stores touch.

use super::Walk;
use crate::spirv::emit::ids;
use crate::spirv::graft::push_new;
use rspirv::dr::{Instruction, Operand};
use rspirv::spirv::{Capability, Dim, ImageOperands, Op, Word};

/// What says how a texel's bits become a number, and not which texel it is.
const EXTENDS: ImageOperands = ImageOperands::SIGN_EXTEND.union(ImageOperands::ZERO_EXTEND);

impl Walk {
    /// Dimensions of the image that `value` holds: which, and whether it has layers.
    fn dimensions(&self, value: Word) -> Option<(Dim, bool)> {
        let mut ty = *self.types.get(&value)?;
        if self.layout.kind(ty)? == Op::TypeSampledImage {
            ty = self.layout.value(ty)?.operands[0].id_ref_any()?;
        }
        match self.layout.value(ty)?.operands[..] {
            [_, Operand::Dim(dim), _, Operand::LiteralBit32(arrayed), ..] => Some((dim, arrayed == 1)),
            _ => None,
        }
    }

    /// `place` as three coordinates, of which the image has `count`.
    fn place(&mut self, place: Word, count: u32, body: &mut Vec<Instruction>) -> Word {
        let (float, zero) = (self.emitter.float(), self.emitter.zero());
        let mut parts: Vec<Word> = (0..count).map(|at| self.emitter.component(body, float, place, at)).collect();
        parts.resize(3, zero);
        let triple = self.emitter.vector(float, 3);
        self.emitter.push(body, Op::CompositeConstruct, triple, ids(&parts))
    }

    /// The first two components of a vector.
    fn pair(&mut self, of: Word, body: &mut Vec<Instruction>) -> Word {
        let float = self.emitter.float();
        let parts = [0, 1].map(|at| self.emitter.component(body, float, of, at));
        let pair = self.emitter.vector(float, 2);
        self.emitter.push(body, Op::CompositeConstruct, pair, ids(&parts))
    }

    /// Counts a look-up through a sampler.
    pub(super) fn sample(&mut self, instruction: &Instruction, body: &mut Vec<Instruction>) -> Result<(), String> {
        let operand = |index: usize| instruction.operands.get(index).and_then(Operand::id_ref_any);
        let (Some(image), Some(at)) = (operand(0), operand(1)) else { return Ok(()) };
        let slot = self.slot(image)?;
        let (dim, arrayed) = self.dimensions(image).ok_or("a look-up without the image's type")?;
        let (kind, count) = match (dim, arrayed) {
            (Dim::Dim2D, false) => (0, 2),
            (Dim::Dim2D, true) => (0, 3),
            (Dim::Dim3D, false) => (1, 3),
            (Dim::DimCube, false) => (2, 3),
            other => return Err(format!("look-ups in {other:?} are not followed")),
        };
        let place = self.place(at, count, body);
        let op = instruction.class.opcode;
        let mask = instruction.operands.iter().position(|operand| matches!(operand, Operand::ImageOperands(_)));
        let asked = mask.map(|mask| match &instruction.operands[mask] {
            Operand::ImageOperands(asked) => (*asked, mask),
            _ => unreachable!("found by its kind"),
        });
        if matches!(op, Op::ImageGather | Op::ImageDrefGather) {
            if asked.is_some() || dim != Dim::Dim2D {
                return Err(format!("a gather in {dim:?} with {asked:?} is not followed"));
            }
            self.call(body, "mark_gathered", &[slot, place]);
            return Ok(());
        }
        let kind = self.emitter.number(kind);
        match asked {
            Some((asked, mask)) if asked.difference(EXTENDS) == ImageOperands::GRAD => {
                let (Some(across), Some(down)) = (operand(mask + 1), operand(mask + 2)) else { return Ok(()) };
                let [across, down] = [across, down].map(|of| self.pair(of, body));
                self.call(body, "mark_gradients", &[slot, place, kind, across, down]);
            }
            Some((asked, mask)) if asked.difference(EXTENDS) == ImageOperands::LOD => {
                let Some(level) = operand(mask + 1) else { return Ok(()) };
                let level = self.as_float(level, body);
                self.call(body, "mark_sampled", &[slot, place, kind, level]);
            }
            None => {
                let float = self.emitter.float();
                let pair = self.emitter.vector(float, 2);
                let capability = Operand::Capability(Capability::ImageQuery);
                let capability = Instruction::new(Op::Capability, None, None, vec![capability]);
                push_new(&mut self.emitter.module.capabilities, capability);
                let at = if count == 2 { self.pair(place, body) } else { place };
                let levels = self.emitter.push(body, Op::ImageQueryLod, pair, ids(&[image, at]));
                let level = self.emitter.component(body, float, levels, 1);
                self.call(body, "mark_sampled", &[slot, place, kind, level]);
            }
            Some((asked, _)) => return Err(format!("a look-up with {asked:?} is not followed")),
        }
        Ok(())
    }

    /// A level is a whole number where the module says so.
    fn as_float(&mut self, level: Word, body: &mut Vec<Instruction>) -> Word {
        let float = self.emitter.float();
        if self.types.get(&level) == Some(&float) {
            return level;
        }
        self.emitter.push(body, Op::ConvertSToF, float, ids(&[level]))
    }

    fn slot(&self, image: Word) -> Result<Word, String> {
        self.images.get(&image).copied().ok_or_else(|| "an image that is not followed to its binding".to_owned())
    }

    /// Counts a texel that is fetched, read or written.
    pub(super) fn texel(
        &mut self,
        instruction: &Instruction,
        writes: bool,
        body: &mut Vec<Instruction>,
    ) -> Result<(), String> {
        let operand = |index: usize| instruction.operands.get(index).and_then(Operand::id_ref_any);
        let (Some(image), Some(at)) = (operand(0), operand(1)) else { return Ok(()) };
        let slot = self.slot(image)?;
        let (dim, arrayed) = self.dimensions(image).ok_or("a texel without the image's type")?;
        let count = match (dim, arrayed) {
            (Dim::Dim2D, false) => 2,
            (Dim::Dim2D, true) | (Dim::Dim3D, false) => 3,
            other => return Err(format!("texels of {other:?} are not followed")),
        };
        let component = self.types.get(&at).and_then(|ty| self.layout.value(*ty)?.operands.first()?.id_ref_any());
        let component = component.ok_or("a texel's place without its type")?;
        let (uint, zero) = (self.emitter.uint(), self.emitter.number(0));
        let mut parts = Vec::new();
        for index in 0..count {
            let part = self.emitter.component(body, component, at, index);
            parts.push(self.as_uint(part, component, body));
        }
        parts.resize(3, zero);
        let triple = self.emitter.vector(uint, 3);
        let place = self.emitter.push(body, Op::CompositeConstruct, triple, ids(&parts));
        let (mut level, mut one_sample) = (zero, zero);
        let mask = instruction.operands.iter().position(|operand| matches!(operand, Operand::ImageOperands(_)));
        if let Some(mask) = mask {
            let Operand::ImageOperands(asked) = instruction.operands[mask] else { unreachable!("found by its kind") };
            let next = operand(mask + 1);
            let target = match asked.difference(EXTENDS) {
                ImageOperands::LOD => Some(&mut level),
                ImageOperands::SAMPLE => Some(&mut one_sample),
                ImageOperands::NONE => None,
                asked => return Err(format!("a texel with {asked:?} is not followed")),
            };
            if let (Some(target), Some(next)) = (target, next) {
                let ty = self.types.get(&next).copied().unwrap_or(uint);
                *target = self.as_uint(next, ty, body);
            }
        }
        let writes = self.emitter.number(u32::from(writes));
        self.call(body, "mark_texel", &[slot, place, level, one_sample, writes]);
        Ok(())
    }

    fn as_uint(&mut self, value: Word, ty: Word, body: &mut Vec<Instruction>) -> Word {
        let uint = self.emitter.uint();
        if ty == uint { value } else { self.emitter.push(body, Op::Bitcast, uint, ids(&[value])) }
    }
}
