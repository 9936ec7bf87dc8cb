//! Acceleration structures, through which a driver's own ray queries trace. A bottom one holds triangles, a top one
//! holds a bottom one where it stands, and is what shaders are given.
//!
//! They are built once, on the device, by commands of build.rs; the caller states the barriers (`Access::StructureWrite`
//! and the like), makes the buffers that they lie in, and keeps what a build reads until its fence.

use super::{Buffer, Gpu};
use crate::caps::StructureRules;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// Vulkan promises that no device aligns scratch to more (minAccelerationStructureScratchOffsetAlignment).
pub(super) const SCRATCH_ALIGNMENT_BYTES: u64 = 256;
/// Instances begin at a multiple of this; so do triangles that follow one.
pub const INPUT_ALIGNMENT_BYTES: u64 = 16;
/// Three corners of three floats.
pub const TRIANGLE_BYTES: u64 = 36;
/// An instance, as Vulkan lays it out.
pub const INSTANCE_BYTES: u64 = size_of::<vk::AccelerationStructureInstanceKHR>() as u64;

/// A buffer that a structure lies in.
pub const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR.as_raw()
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw(),
);
/// A buffer that a build reads its triangles or instances from.
pub const INPUT: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR.as_raw()
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw(),
);
/// A buffer that a build keeps its notes in.
pub const SCRATCH: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
    vk::BufferUsageFlags::STORAGE_BUFFER.as_raw() | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw(),
);

/// Geometry or instances that a structure is built over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// Triangles, `TRIANGLE_BYTES` each. `is_opaque`: a ray may stop at any of them without asking the shader.
    Triangles { count: u32, is_opaque: bool },
    /// One bottom structure, `INSTANCE_BYTES`.
    Instance,
}

/// What a driver asks for a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    pub structure_bytes: u64,
    /// While it is built; with room to align its start.
    pub scratch_bytes: u64,
}

impl Over {
    fn level(self) -> vk::AccelerationStructureTypeKHR {
        match self {
            Self::Triangles { .. } => vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
            Self::Instance => vk::AccelerationStructureTypeKHR::TOP_LEVEL,
        }
    }

    /// Bytes of a structure over this where a driver goes by `rules`.
    pub fn bytes(self, rules: &StructureRules) -> u64 {
        match self {
            Self::Triangles { count, .. } => rules.over_triangles(count),
            Self::Instance => rules.over_instance(),
        }
    }

    pub(super) fn count(self) -> u32 {
        match self {
            Self::Triangles { count, .. } => count,
            Self::Instance => 1,
        }
    }

    /// `input`: address of the triangles or the instance; sizes do not depend on it.
    pub(super) fn geometry(self, input: u64) -> vk::AccelerationStructureGeometryKHR<'static> {
        let data = vk::DeviceOrHostAddressConstKHR { device_address: input };
        let geometry = vk::AccelerationStructureGeometryKHR::default();
        match self {
            Self::Triangles { count, is_opaque } => {
                let triangles = vk::AccelerationStructureGeometryTrianglesDataKHR::default()
                    .vertex_format(vk::Format::R32G32B32_SFLOAT)
                    .vertex_data(data)
                    .vertex_stride(TRIANGLE_BYTES / 3)
                    .max_vertex((3 * count).saturating_sub(1))
                    .index_type(vk::IndexType::NONE_KHR);
                let flags = if is_opaque { vk::GeometryFlagsKHR::OPAQUE } else { vk::GeometryFlagsKHR::empty() };
                geometry
                    .geometry_type(vk::GeometryTypeKHR::TRIANGLES)
                    .geometry(vk::AccelerationStructureGeometryDataKHR { triangles })
                    .flags(flags)
            }
            Self::Instance => {
                let instances = vk::AccelerationStructureGeometryInstancesDataKHR::default().data(data);
                geometry
                    .geometry_type(vk::GeometryTypeKHR::INSTANCES)
                    .geometry(vk::AccelerationStructureGeometryDataKHR { instances })
            }
        }
    }

    pub(super) fn build_info<'a>(
        self,
        geometries: &'a [vk::AccelerationStructureGeometryKHR<'a>],
    ) -> vk::AccelerationStructureBuildGeometryInfoKHR<'a> {
        vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(self.level())
            .flags(vk::BuildAccelerationStructureFlagsKHR::PREFER_FAST_TRACE)
            .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
            .geometries(geometries)
    }

    /// What the driver of `gpu`, which has ray queries, asks for it.
    pub fn sizes(self, gpu: &Gpu) -> Sizes {
        let geometries = [self.geometry(0)];
        let mut found = vk::AccelerationStructureBuildSizesInfoKHR::default();
        // SAFETY: a live device with the extension; the geometries outlive the call, which reads no address.
        unsafe {
            gpu.structures().get_acceleration_structure_build_sizes(
                vk::AccelerationStructureBuildTypeKHR::DEVICE,
                &self.build_info(&geometries),
                &[self.count()],
                &mut found,
            );
        }
        Sizes {
            structure_bytes: found.acceleration_structure_size,
            scratch_bytes: found.build_scratch_size + SCRATCH_ALIGNMENT_BYTES,
        }
    }
}

/// A structure in a buffer of its own; both end when it is dropped, which must be after the fence of its last frame.
pub struct Structure {
    gpu: Arc<Gpu>,
    pub(super) handle: vk::AccelerationStructureKHR,
    pub(super) over: Over,
    /// The buffer that barriers name.
    pub buffer: Buffer,
    /// Name of the structure that its instances are of.
    pub beneath: Option<String>,
}

impl Structure {
    /// Makes room for one in `buffer`, made with `STORAGE` and as long as `Over::sizes` says. Nothing is in it before it is
    /// built.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, buffer: Buffer, over: Over) -> Result<Self> {
        let info =
            vk::AccelerationStructureCreateInfoKHR::default().buffer(buffer.handle).size(buffer.bytes).ty(over.level());
        // SAFETY: a live device with the extension, and a live buffer of the right use.
        let handle = unsafe { gpu.structures().create_acceleration_structure(&info, None) }
            .map_err(|result| Error::device(format!("creating structure {}: {result}", buffer.name)))?;
        gpu.name(handle, &buffer.name);
        Ok(Self { gpu: gpu.clone(), handle, over, buffer, beneath: None })
    }

    /// Writes an instance of it, where it was built, as a top structure takes it. `bytes`: `INSTANCE_BYTES`.
    pub fn write_instance(&self, bytes: &mut [u8]) {
        let info = vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(self.handle);
        // SAFETY: a live structure of a live device.
        let address = unsafe { self.gpu.structures().get_acceleration_structure_device_address(&info) };
        // Rows of the identity; visible to every ray (the mask), in no order of shaders.
        let rows: [f32; 12] = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let words = [0xff00_0000u32, 0];
        let [transform, index_and_mask, reference] =
            [bytemuck::bytes_of(&rows), bytemuck::bytes_of(&words), bytemuck::bytes_of(&address)];
        bytes.copy_from_slice(&[transform, index_and_mask, reference].concat());
    }
}

impl Drop for Structure {
    fn drop(&mut self) {
        // SAFETY: the frame's fence was waited for; the buffer goes after the handle.
        unsafe { self.gpu.structures().destroy_acceleration_structure(self.handle, None) };
    }
}

/// First byte of `input`, made with `INPUT`, that an instance may begin at.
pub fn input_start(input: &Buffer) -> u64 {
    let address = input.address();
    address.next_multiple_of(INPUT_ALIGNMENT_BYTES) - address
}
