//! What a compute shader does with memory: its invocations, and what each of them reads and writes, in order.

/// An access of one invocation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Place of its first byte.
    pub address: u64,
    /// At least one.
    pub bytes: u32,
    pub is_write: bool,
}

impl Access {
    pub fn read(address: u64, bytes: u32) -> Self {
        Self { address, bytes, is_write: false }
    }

    pub fn write(address: u64, bytes: u32) -> Self {
        Self { address, bytes, is_write: true }
    }
}

/// A compute shader as far as its memory goes.
pub trait Kernel {
    /// Workgroups across, down and deep.
    fn groups(&self) -> [u32; 3];

    /// Invocations of a workgroup, across and down.
    fn group_size(&self) -> [u32; 2];

    /// Adds what an invocation accesses, in the order of the shader, and None where it leaves out what others do. The nth accesses of
    /// a warp's invocations are one instruction. `local`: its place in its workgroup.
    fn accesses(&self, group: [u32; 3], local: [u32; 2], out: &mut Vec<Option<Access>>);
}

/// Workgroups in the order in which devices begin them: across, then down, then deep.
pub fn groups_of(kernel: &dyn Kernel) -> impl Iterator<Item = [u32; 3]> {
    let [across, down, deep] = kernel.groups();
    (0..deep).flat_map(move |z| (0..down).flat_map(move |y| (0..across).map(move |x| [x, y, z])))
}

/// Every access of a kernel, workgroup by workgroup and row by row in each.
pub fn accesses_of(kernel: &dyn Kernel) -> Vec<Access> {
    let [width, height] = kernel.group_size();
    let mut all = Vec::new();
    for group in groups_of(kernel) {
        for local in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
            kernel.accesses(group, local, &mut all);
        }
    }
    all.into_iter().flatten().collect()
}
