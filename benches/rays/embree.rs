//! Embree 4, loaded at run time: no part of the build, and nothing happens where it is missing.
//!
//! Binds the few functions of its C interface that the bench needs, as the manual of Embree 4
//! describes them.

use std::collections::HashMap;
use std::ffi::{CString, c_char, c_int, c_uint, c_void};
use std::sync::atomic::{AtomicIsize, Ordering};
use std::sync::{Arc, Mutex};

use clap::ValueEnum;
use libloading::{Library, Symbol};
use softbox::geometry::{Hit, Shapes};
use softbox::math::Ray;

use crate::embree_query::{Arguments, COHERENT, Handle, RayHit, RayHit16};
use crate::ray_bench::{Kind, System, Tracer};

/// Names under which systems install the library.
const USUAL_NAMES: [&str; 4] = [
    "libembree4.so.4",
    "libembree4.so",
    "libembree4.dylib",
    "embree4.dll",
];

/// Name of the system that traces sixteen primary rays at a time.
pub(crate) const PACKETS: &str = "embree-packets";

/// `RTC_SCENE_FLAG_ROBUST`.
const ROBUST: c_int = 4;
/// `RTC_BUILD_QUALITY_MEDIUM`, the default.
const MEDIUM: c_int = 1;
/// `RTC_GEOMETRY_TYPE_TRIANGLE`.
const TRIANGLE: c_int = 0;
/// `RTC_BUFFER_TYPE_INDEX`, `RTC_FORMAT_UINT3`.
const INDICES: (c_int, c_int) = (0, 0x5003);
/// `RTC_BUFFER_TYPE_VERTEX`, `RTC_FORMAT_FLOAT3`.
const VERTICES: (c_int, c_int) = (1, 0x9003);
/// `RTC_DEVICE_PROPERTY_VERSION`.
const VERSION: c_int = 0;
type OnMemory = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;
type Trace1 = unsafe extern "C" fn(Handle, *mut RayHit, *mut Arguments);
type Trace16 = unsafe extern "C" fn(*const i32, Handle, *mut RayHit16, *mut Arguments);
type SetBuffer =
    unsafe extern "C" fn(Handle, c_int, c_uint, c_int, *const c_void, usize, usize, usize);

macro_rules! interface {
    ($($field:ident = $name:literal: $type:ty;)*) => {
        /// The functions of the library.
        pub(crate) struct Embree { $($field: Symbol<'static, $type>,)* }

        impl Embree {
            fn bind(library: &'static Library) -> Result<Self, libloading::Error> {
                // SAFETY: the types are those of the C interface of Embree 4, see `open`.
                unsafe { Ok(Self { $($field: library.get($name)?,)* }) }
            }
        }
    };
}

interface! {
    new_device = b"rtcNewDevice\0": unsafe extern "C" fn(*const c_char) -> Handle;
    release_device = b"rtcReleaseDevice\0": unsafe extern "C" fn(Handle);
    device_property = b"rtcGetDeviceProperty\0": unsafe extern "C" fn(Handle, c_int) -> isize;
    device_error = b"rtcGetDeviceError\0": unsafe extern "C" fn(Handle) -> c_int;
    watch_memory = b"rtcSetDeviceMemoryMonitorFunction\0": unsafe extern "C" fn(Handle, OnMemory, *mut c_void);
    new_scene = b"rtcNewScene\0": unsafe extern "C" fn(Handle) -> Handle;
    release_scene = b"rtcReleaseScene\0": unsafe extern "C" fn(Handle);
    set_flags = b"rtcSetSceneFlags\0": unsafe extern "C" fn(Handle, c_int);
    set_quality = b"rtcSetSceneBuildQuality\0": unsafe extern "C" fn(Handle, c_int);
    commit_scene = b"rtcCommitScene\0": unsafe extern "C" fn(Handle);
    new_geometry = b"rtcNewGeometry\0": unsafe extern "C" fn(Handle, c_int) -> Handle;
    release_geometry = b"rtcReleaseGeometry\0": unsafe extern "C" fn(Handle);
    set_buffer = b"rtcSetSharedGeometryBuffer\0": SetBuffer;
    commit_geometry = b"rtcCommitGeometry\0": unsafe extern "C" fn(Handle);
    attach = b"rtcAttachGeometry\0": unsafe extern "C" fn(Handle, Handle) -> c_uint;
    intersect1 = b"rtcIntersect1\0": Trace1;
    occluded1 = b"rtcOccluded1\0": Trace1;
    intersect16 = b"rtcIntersect16\0": Trace16;
}

impl Embree {
    /// Loads the library called `path`, or one of the usual names. It stays loaded.
    ///
    /// # Errors
    /// A sentence on why there is none.
    pub(crate) fn open(path: Option<&str>) -> Result<&'static Self, String> {
        let names = path.map_or(USUAL_NAMES.to_vec(), |path| vec![path]);
        let mut problem = String::new();
        for name in names {
            // SAFETY: a library runs code of its own when it is loaded; the user asked for this one.
            let library = match unsafe { Library::new(name) } {
                Ok(library) => library,
                Err(error) => {
                    problem = error.to_string();
                    continue;
                }
            };
            let embree = Self::bind(Box::leak(Box::new(library))).map_err(|e| e.to_string())?;
            let embree: &'static Self = Box::leak(Box::new(embree));
            let device = Device::new(embree, 1);
            // SAFETY: the device lives; this function has been the same since version 3.
            let version = unsafe { (embree.device_property)(device.handle, VERSION) };
            return match version / 10_000 {
                4 => Ok(embree),
                other => Err(format!("{name} is version {other}, not 4")),
            };
        }
        Err(problem)
    }

    /// Every way to use it that is measured.
    pub(crate) fn systems(&'static self) -> Vec<System> {
        let plain = Mode {
            flags: 0,
            is_packet: false,
            flushes: true,
        };
        let robust = Mode {
            flags: ROBUST,
            ..plain
        };
        let packets = Mode {
            is_packet: true,
            ..plain
        };
        let denormals = Mode {
            flushes: false,
            ..plain
        };
        let all = Kind::value_variants();
        vec![
            self.system(crate::ray_bench::ANCHOR, all, plain),
            self.system(PACKETS, &[Kind::Primary], packets),
            self.system("embree-robust", all, robust),
            self.system("embree-denormals", all, denormals),
        ]
    }

    fn system(&'static self, name: &str, kinds: &'static [Kind], mode: Mode) -> System {
        let devices = Mutex::new(HashMap::new());
        System::new(name, kinds, move |shapes, threads| {
            let mut devices = devices.lock().expect("no panic with the lock");
            let device = devices
                .entry(threads)
                .or_insert_with(|| Arc::new(Device::new(self, threads)));
            let input = Input::new(shapes);
            let device = Arc::clone(device);
            Box::new(move || Box::new(Scene::new(device, input, mode)))
        })
    }
}

/// A way to use the library.
#[derive(Clone, Copy)]
struct Mode {
    flags: c_int,
    /// Sixteen rays at a time.
    is_packet: bool,
    /// Denormal numbers count as zero meanwhile, as its manual asks.
    flushes: bool,
}

/// A device with so many threads, which counts its memory.
struct Device {
    embree: &'static Embree,
    handle: Handle,
    bytes: Box<AtomicIsize>,
}

// SAFETY: Embree's interface may be used from several threads.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    fn new(embree: &'static Embree, threads: usize) -> Self {
        let settings = CString::new(format!("threads={threads},set_affinity=0"));
        let settings = settings.expect("no zero inside");
        let bytes = Box::new(AtomicIsize::new(0));
        let counter: *const AtomicIsize = &raw const *bytes;
        // SAFETY: the settings outlive the call, the counter outlives the device.
        let handle = unsafe {
            let handle = (embree.new_device)(settings.as_ptr());
            assert!(!handle.is_null(), "Embree gives no device");
            (embree.watch_memory)(handle, count_bytes, counter.cast_mut().cast());
            handle
        };
        Self {
            embree,
            handle,
            bytes,
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: no scene of the device is left, since scenes hold it.
        unsafe { (self.embree.release_device)(self.handle) }
    }
}

unsafe extern "C" fn count_bytes(counter: *mut c_void, bytes: isize, _is_after: bool) -> bool {
    // SAFETY: `Device::new` gave the address of a counter that lives as long as the device.
    unsafe { &*counter.cast::<AtomicIsize>() }.fetch_add(bytes, Ordering::Relaxed);
    true
}

/// The mesh in Embree's form: vertices of 16 bytes, since it reads them so.
struct Input {
    vertices: Vec<[f32; 4]>,
    triangles: Vec<[u32; 3]>,
}

impl Input {
    fn new(shapes: &Shapes) -> Self {
        Self {
            vertices: shapes
                .positions
                .iter()
                .map(|p| p.extend(1.0).to_array())
                .collect(),
            triangles: shapes.triangles.clone(),
        }
    }
}

struct Scene {
    device: Arc<Device>,
    handle: Handle,
    mode: Mode,
    /// Embree reads it while it builds, and may later.
    _input: Input,
    bytes: usize,
}

// SAFETY: Embree's interface may be used from several threads.
unsafe impl Send for Scene {}
// SAFETY: as above; a committed scene is only read.
unsafe impl Sync for Scene {}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: the scene is released once, before its device.
        unsafe { (self.device.embree.release_scene)(self.handle) }
    }
}

impl Scene {
    fn new(device: Arc<Device>, input: Input, mode: Mode) -> Self {
        let embree = device.embree;
        let before = device.bytes.load(Ordering::Relaxed);
        let Input {
            vertices,
            triangles,
        } = &input;
        // SAFETY: the buffers live as long as the scene; sizes and strides are theirs.
        let handle = unsafe {
            let scene = (embree.new_scene)(device.handle);
            (embree.set_flags)(scene, mode.flags);
            (embree.set_quality)(scene, MEDIUM);
            let mesh = (embree.new_geometry)(device.handle, TRIANGLE);
            let (kind, format) = VERTICES;
            let data = vertices.as_ptr().cast();
            (embree.set_buffer)(mesh, kind, 0, format, data, 0, 16, vertices.len());
            let (kind, format) = INDICES;
            let data = triangles.as_ptr().cast();
            (embree.set_buffer)(mesh, kind, 0, format, data, 0, 12, triangles.len());
            (embree.commit_geometry)(mesh);
            (embree.attach)(scene, mesh);
            (embree.release_geometry)(mesh);
            (embree.commit_scene)(scene);
            assert_eq!(
                (embree.device_error)(device.handle),
                0,
                "Embree cannot build"
            );
            scene
        };
        let bytes = device.bytes.load(Ordering::Relaxed) - before;
        Self {
            handle,
            mode,
            _input: input,
            bytes: bytes.max(0).unsigned_abs(),
            device,
        }
    }

    fn closest_by_one(&self, rays: &[Ray], hits: &mut [Hit]) {
        let intersect = *self.device.embree.intersect1;
        let mut arguments = Arguments::new(0);
        for (ray, hit) in rays.iter().zip(hits) {
            let mut query = RayHit::new(ray);
            // SAFETY: the scene is committed, and both structures are those of the interface.
            unsafe { intersect(self.handle, &raw mut query, &raw mut arguments) };
            *hit = query.hit();
        }
    }

    fn closest_by_sixteen(&self, rays: &[Ray], hits: &mut [Hit]) {
        let intersect = *self.device.embree.intersect16;
        let mut arguments = Arguments::new(COHERENT);
        for (rays, hits) in rays.chunks(16).zip(hits.chunks_mut(16)) {
            let (lanes, mut packet) = RayHit16::new(rays);
            // SAFETY: as for a single ray; lanes and packet are aligned to 64 bytes.
            unsafe {
                intersect(
                    lanes.0.as_ptr(),
                    self.handle,
                    &raw mut packet,
                    &raw mut arguments,
                );
            }
            for (i, hit) in hits.iter_mut().enumerate() {
                *hit = packet.hit(i);
            }
        }
    }

    fn occluded_by_one(&self, rays: &[Ray], occluded: &mut [bool]) {
        let test = *self.device.embree.occluded1;
        let mut arguments = Arguments::new(0);
        for (ray, occluded) in rays.iter().zip(occluded) {
            let mut query = RayHit::new(ray);
            // SAFETY: a `RTCRayHit` starts with the `RTCRay` that is wanted here.
            unsafe { test(self.handle, &raw mut query, &raw mut arguments) };
            *occluded = query.t_far() < 0.0;
        }
    }
}

impl Tracer for Scene {
    fn closest_hit(&self, rays: &[Ray], hits: &mut [Hit]) {
        let _flush = self.mode.flushes.then(FlushToZero::start);
        if self.mode.is_packet {
            self.closest_by_sixteen(rays, hits);
        } else {
            self.closest_by_one(rays, hits);
        }
    }

    fn any_hit(&self, rays: &[Ray], occluded: &mut [bool]) {
        let _flush = self.mode.flushes.then(FlushToZero::start);
        self.occluded_by_one(rays, occluded);
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}

/// While it lives, denormal numbers are zero on this thread: once per batch, around Embree only,
/// since it would change the bits of other systems.
struct FlushToZero {
    #[cfg(target_arch = "x86_64")]
    before: u32,
}

#[cfg(target_arch = "x86_64")]
impl FlushToZero {
    /// Flush to zero, and denormals are zero.
    const BITS: u32 = 0x8040;

    fn start() -> Self {
        let mut before = 0_u32;
        // SAFETY: writes the control register of vector arithmetic to a number of its size.
        unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut before) };
        Self::set(before | Self::BITS);
        Self { before }
    }

    fn set(control: u32) {
        // SAFETY: only the two bits change, and they are set back before the batch is over.
        unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const control) };
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for FlushToZero {
    fn drop(&mut self) {
        Self::set(self.before);
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl FlushToZero {
    fn start() -> Self {
        Self {}
    }
}
