//! An importer in Rust: the functions of FMI as C calls them.

// An instance is opaque here.
#![allow(unsafe_code, dead_code, improper_ctypes)]

use std::ffi::{CString, c_char, c_void};
use std::ptr;

use dalembert_fmu::boundary::{Instance, LogMessage, Status};

unsafe extern "C" {
    fn fmi3InstantiateCoSimulation(
        name: *const c_char,
        token: *const c_char,
        resources: *const c_char,
        visible: bool,
        logging: bool,
        events: bool,
        early: bool,
        required: *const u32,
        length: usize,
        environment: *mut c_void,
        log: Option<LogMessage>,
        update: Option<unsafe extern "C" fn()>,
    ) -> *mut Instance;
    fn fmi3FreeInstance(instance: *mut Instance);
    fn fmi3EnterInitializationMode(
        i: *mut Instance,
        d: bool,
        t: f64,
        start: f64,
        s: bool,
        stop: f64,
    ) -> Status;
    fn fmi3ExitInitializationMode(instance: *mut Instance) -> Status;
    fn fmi3DoStep(
        instance: *mut Instance,
        point: f64,
        size: f64,
        final_: bool,
        event: *mut bool,
        terminate: *mut bool,
        early: *mut bool,
        last: *mut f64,
    ) -> Status;
    fn fmi3GetDirectionalDerivative(
        instance: *mut Instance,
        unknowns: *const u32,
        unknowns_length: usize,
        knowns: *const u32,
        knowns_length: usize,
        seed: *const f64,
        seed_length: usize,
        sensitivity: *mut f64,
        sensitivity_length: usize,
    ) -> Status;
    fn fmi2GetInteger(i: *mut Instance, vr: *const u32, n: usize, values: *mut i32) -> Status;
    fn fmi2SetInteger(i: *mut Instance, vr: *const u32, n: usize, values: *const i32) -> Status;
    fn fmi3Terminate(instance: *mut Instance) -> Status;
    fn fmi3Reset(instance: *mut Instance) -> Status;
    fn fmi3GetFMUState(instance: *mut Instance, state: *mut *mut c_void) -> Status;
    fn fmi3SetFMUState(instance: *mut Instance, state: *const c_void) -> Status;
    fn fmi3FreeFMUState(instance: *mut Instance, state: *mut *mut c_void) -> Status;
    fn fmi3SerializedFMUStateSize(instance: *mut Instance, state: *const c_void, size: *mut usize) -> Status;
    fn fmi3SerializeFMUState(
        instance: *mut Instance,
        state: *const c_void,
        to: *mut u8,
        size: usize,
    ) -> Status;
    fn fmi3DeserializeFMUState(
        i: *mut Instance,
        from: *const u8,
        size: usize,
        state: *mut *mut c_void,
    ) -> Status;
    fn fmi3GetFloat64(i: *mut Instance, vr: *const u32, n: usize, values: *mut f64, length: usize) -> Status;
    fn fmi3SetFloat64(
        i: *mut Instance,
        vr: *const u32,
        n: usize,
        values: *const f64,
        length: usize,
    ) -> Status;
    fn fmi3GetFloat32(i: *mut Instance, vr: *const u32, n: usize, values: *mut f32, length: usize) -> Status;
    fn fmi3SetFloat32(
        i: *mut Instance,
        vr: *const u32,
        n: usize,
        values: *const f32,
        length: usize,
    ) -> Status;
    fn fmi3SetUInt8(i: *mut Instance, vr: *const u32, n: usize, values: *const u8, length: usize) -> Status;
    fn fmi3GetUInt8(i: *mut Instance, vr: *const u32, n: usize, values: *mut u8, length: usize) -> Status;
    fn fmi3SetInt16(i: *mut Instance, vr: *const u32, n: usize, values: *const i16, length: usize) -> Status;
    fn fmi3GetInt16(i: *mut Instance, vr: *const u32, n: usize, values: *mut i16, length: usize) -> Status;
}

/// An instance, and its description, by which variables are found.
pub struct Imported {
    instance: *mut Instance,
    description: String,
}

macro_rules! values {
    ($($of:ty: $get:ident $set:ident $from:ident $to:ident;)*) => { $(
        pub fn $get<const K: usize>(&self, names: [&str; K]) -> Result<[$of; K], Status> {
            let (references, mut values) = (self.references(names), [0 as $of; K]);
            // SAFETY: arrays of these lengths.
            done(unsafe { $from(self.instance, references.as_ptr(), K, values.as_mut_ptr(), K) }).map(|()| values)
        }

        pub fn $set(&mut self, name: &str, value: $of) -> Result<(), Status> {
            let references = self.references([name]);
            // SAFETY: arrays of these lengths.
            done(unsafe { $to(self.instance, references.as_ptr(), 1, [value].as_ptr(), 1) })
        }
    )* };
}

fn done(status: Status) -> Result<(), Status> {
    if status == Status::Ok { Ok(()) } else { Err(status) }
}

impl Imported {
    /// An instance of the unit with this description.
    pub fn new(description: String, token: &str) -> Self {
        let token = CString::new(token).unwrap();
        // SAFETY: texts that end with a zero byte; no callback.
        let instance = unsafe {
            let (name, none) = (c"one".as_ptr(), ptr::null());
            let text = token.as_ptr();
            fmi3InstantiateCoSimulation(
                name,
                text,
                none,
                false,
                false,
                false,
                false,
                ptr::null(),
                0,
                ptr::null_mut(),
                None,
                None,
            )
        };
        assert!(!instance.is_null());
        Self { instance, description }
    }

    fn references<const K: usize>(&self, names: [&str; K]) -> [u32; K] {
        names.map(|name| {
            let at = format!("name=\"{name}\" valueReference=\"");
            let rest = self.description.split_once(&at).expect("a variable of this name").1;
            rest.split_once('"').unwrap().0.parse().unwrap()
        })
    }

    pub fn start_at(&mut self, time: f64) -> Result<(), Status> {
        self.enter_initialization(time)?;
        self.exit_initialization()
    }

    pub fn step(&mut self, point: f64, size: f64) -> Result<f64, Status> {
        let (mut event, mut terminate, mut early, mut last) = (true, true, true, f64::NAN);
        // SAFETY: the instance is alive, and these are variables.
        let status = unsafe {
            fmi3DoStep(self.instance, point, size, false, &mut event, &mut terminate, &mut early, &mut last)
        };
        done(status)?;
        assert!(!event && !terminate && !early);
        Ok(last)
    }

    pub fn along<const U: usize, const K: usize>(
        &self,
        unknowns: [&str; U],
        knowns: [&str; K],
        seed: [f64; K],
    ) -> Result<[f64; U], Status> {
        let (unknowns, knowns, mut sensitivity) =
            (self.references(unknowns), self.references(knowns), [0.0; U]);
        let (of, by, to) = (unknowns.as_ptr(), knowns.as_ptr(), sensitivity.as_mut_ptr());
        // SAFETY: arrays of these lengths.
        done(unsafe { fmi3GetDirectionalDerivative(self.instance, of, U, by, K, seed.as_ptr(), K, to, U) })?;
        Ok(sensitivity)
    }

    pub fn enter_initialization(&mut self, time: f64) -> Result<(), Status> {
        // SAFETY: the instance is alive.
        done(unsafe { fmi3EnterInitializationMode(self.instance, false, 0.0, time, false, 0.0) })
    }

    pub fn exit_initialization(&mut self) -> Result<(), Status> {
        // SAFETY: the instance is alive.
        done(unsafe { fmi3ExitInitializationMode(self.instance) })
    }

    pub fn terminate(&mut self) -> Result<(), Status> {
        // SAFETY: the instance is alive.
        done(unsafe { fmi3Terminate(self.instance) })
    }

    pub fn reset(&mut self) -> Result<(), Status> {
        // SAFETY: the instance is alive.
        done(unsafe { fmi3Reset(self.instance) })
    }

    /// By FMI 2.0.
    pub fn integer(&self, name: &str) -> Result<i32, Status> {
        let (reference, mut value) = (self.references([name]), 0);
        // SAFETY: arrays of one.
        done(unsafe { fmi2GetInteger(self.instance, reference.as_ptr(), 1, &mut value) }).map(|()| value)
    }

    /// By FMI 2.0.
    pub fn set_integer(&mut self, name: &str, value: i32) -> Result<(), Status> {
        let reference = self.references([name]);
        // SAFETY: arrays of one.
        done(unsafe { fmi2SetInteger(self.instance, reference.as_ptr(), 1, &value) })
    }

    /// Its state as bytes.
    pub fn bytes(&mut self) -> Vec<u8> {
        let (mut state, mut size) = (ptr::null_mut(), 0);
        // SAFETY: the instance and the state are alive; the array is of this length.
        unsafe {
            done(fmi3GetFMUState(self.instance, &mut state)).unwrap();
            done(fmi3SerializedFMUStateSize(self.instance, state, &mut size)).unwrap();
            let mut bytes = vec![0; size];
            done(fmi3SerializeFMUState(self.instance, state, bytes.as_mut_ptr(), size)).unwrap();
            done(fmi3FreeFMUState(self.instance, &mut state)).unwrap();
            bytes
        }
    }

    /// Goes on from these bytes.
    pub fn set_bytes(&mut self, bytes: &[u8]) -> Result<(), Status> {
        let mut state = ptr::null_mut();
        // SAFETY: the instance and the state are alive; the array is of this length.
        unsafe {
            done(fmi3DeserializeFMUState(self.instance, bytes.as_ptr(), bytes.len(), &mut state))?;
            done(fmi3SetFMUState(self.instance, state)).unwrap();
            done(fmi3FreeFMUState(self.instance, &mut state))
        }
    }

    /// Its state, written as bytes and read back, is that of the instance from now on.
    pub fn through_bytes(&mut self) -> Result<Vec<u8>, Status> {
        let bytes = self.bytes();
        self.set_bytes(&bytes).map(|()| bytes)
    }

    values! {
        f64: double set_double fmi3GetFloat64 fmi3SetFloat64;
        f32: single set_single fmi3GetFloat32 fmi3SetFloat32;
        u8: byte set_byte fmi3GetUInt8 fmi3SetUInt8;
        i16: short set_short fmi3GetInt16 fmi3SetInt16;
    }
}

impl Drop for Imported {
    fn drop(&mut self) {
        // SAFETY: made in `new`, and not used any more.
        unsafe { fmi3FreeInstance(self.instance) }
    }
}
