//! Shaders as another device's compiler may have understood them.

use crate::modes::MODES;
use crate::{rewrite, tables};
use ash::vk;

pub unsafe extern "system" fn create_shader_module(
    device: vk::Device,
    info: *const vk::ShaderModuleCreateInfo<'_>,
    allocator: *const vk::AllocationCallbacks<'_>,
    module: *mut vk::ShaderModule,
) -> vk::Result {
    let table = tables::device(device);
    // SAFETY: the next layer's function; the program's words, and those written from them, live as long as the call.
    unsafe {
        let next = table.next.fp_v1_0().create_shader_module;
        if MODES.contract.is_none() && MODES.last_bit.is_none() {
            return next(device, info, allocator, module);
        }
        let words = std::slice::from_raw_parts((*info).p_code, (*info).code_size / size_of::<u32>());
        let words = rewrite::rewritten(words, &MODES).unwrap_or_else(|why| crate::fail(&format!("a shader: {why}")));
        let info = vk::ShaderModuleCreateInfo { code_size: size_of_val(&words[..]), p_code: words.as_ptr(), ..*info };
        next(device, &info, allocator, module)
    }
}
