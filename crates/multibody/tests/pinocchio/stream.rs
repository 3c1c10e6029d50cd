//! Numbers by name: SplitMix64 seeded with the FNV-1a hash of a key, as in tests/pinocchio/stream.py.

/// The stream of one key.
pub struct Stream(u64);

impl Stream {
    pub fn new(key: &str) -> Self {
        Self(key.bytes().fold(0xCBF2_9CE4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x100_0000_01B3)))
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 * 2f64.powi(-53)
    }

    /// Uniform in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// In [−1, −½) or [½, 1).
    pub fn weight(&mut self) -> f64 {
        let u = self.unit();
        if u < 0.5 { u - 1.0 } else { u }
    }

    /// An index below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
}

// What tests/pinocchio/stream.py draws.
const PYTHON: [u64; 2] = [0x8EAA_557E_8BA5_DA05, 0xA8B0_FF2B_6116_5214];

#[test]
fn stream_is_that_of_python() {
    let mut stream = Stream::new("panda/free/17/v/panda_joint3");
    assert_eq!([stream.next(), stream.next()], PYTHON);
}
