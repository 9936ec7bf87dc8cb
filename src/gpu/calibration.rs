//! The device's clock read beside the host's, at one moment (VK_EXT_calibrated_timestamps): whether a tick is as long
//! as the device says shows without a submit between.

use super::failure::failed;
use crate::error::Result;
use ash::vk;

/// The host's clock that counts nanoseconds and is never set; one that the kernel corrects, like `std::time::Instant`,
/// first.
const HOST_CLOCKS: [vk::TimeDomainEXT; 2] =
    [vk::TimeDomainEXT::CLOCK_MONOTONIC, vk::TimeDomainEXT::CLOCK_MONOTONIC_RAW];

/// Both clocks at one moment.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// Ticks, as timestamps have them.
    pub device_ticks: u64,
    pub host_ns: u64,
    /// How far apart in time the two may have been read.
    pub deviation_ns: u64,
}

/// A device that says what both clocks show.
pub struct Calibration {
    functions: ash::ext::calibrated_timestamps::Device,
    host: vk::TimeDomainEXT,
}

impl Calibration {
    /// `device`: opened with the extension. None: it knows no clock of the host that counts nanoseconds (on Windows that
    /// counts in steps of another length).
    pub(super) fn of(
        entry: &ash::Entry,
        instance: &ash::Instance,
        physical: vk::PhysicalDevice,
        device: &ash::Device,
    ) -> Option<Self> {
        let of_instance = ash::ext::calibrated_timestamps::Instance::new(entry, instance);
        // SAFETY: a live instance and one of its physical devices, which has the extension.
        let domains = unsafe { of_instance.get_physical_device_calibrateable_time_domains(physical) }.ok()?;
        let host = HOST_CLOCKS.into_iter().find(|clock| domains.contains(clock))?;
        let functions = ash::ext::calibrated_timestamps::Device::new(instance, device);
        domains.contains(&vk::TimeDomainEXT::DEVICE).then_some(Self { functions, host })
    }

    /// Errors: the driver cannot read them (exit code 4).
    pub fn now(&self) -> Result<Moment> {
        let asked = [vk::TimeDomainEXT::DEVICE, self.host]
            .map(|domain| vk::CalibratedTimestampInfoEXT::default().time_domain(domain));
        // SAFETY: a live device with the extension; both clocks are among those that it knows.
        let (read, deviation_ns) = unsafe { self.functions.get_calibrated_timestamps(&asked) }
            .map_err(|result| failed("reading the device's clock beside the host's", result))?;
        Ok(Moment { device_ticks: read[0], host_ns: read[1], deviation_ns })
    }
}
