//! The splittings that there are, by their shares of the step.

use core::marker::PhantomData;

use super::{Splitting, Sums};
use crate::run::composition::symmetric;

impl Splitting<6> {
    /// Order 4 with 6 gradients a step (Blanes and Moan 2002, SRKN₆ᵇ).
    #[must_use]
    pub const fn blanes_moan_4() -> Self {
        Self { sums: PhantomData }
    }
}

impl Splitting<11> {
    /// Order 6 with 11 gradients a step (Blanes and Moan 2002, SRKN₁₁ᵇ).
    #[must_use]
    pub const fn blanes_moan_6() -> Self {
        Self { sums: PhantomData }
    }
}

impl Splitting<19> {
    /// Order 8 with 19 gradients a step (Blanes, Casas and Escorihuela-Tomàs 2022, A₁₉): 20 drifts with 19
    /// kicks between them.
    ///
    /// Gradients to an error of q at t = 100, as multiples of those of order 6 (a chain: of eight masses, at
    /// t = 50). The composition of order 8 takes 1.3 to 1.9 times as many as this.
    ///
    /// | | 1e-6 | 1e-8 | 1e-9 | 1e-10 | 1e-11 | 1e-12 |
    /// |---|---|---|---|---|---|---|
    /// | (r² − 1)²r² | 1.60 | 1.09 | 1.01 | 0.86 | 0.80 | 0.74 |
    /// | Hénon–Heiles | 1.38 | 1.18 | 1.09 | 1.01 | 0.87 | 0.80 |
    /// | Kepler, e = ½ | 0.87 | 0.63 | 0.59 | 0.54 | 0.54 | |
    /// | chain | 1.88 | 1.18 | 1.01 | 0.93 | 0.80 | 0.74 |
    #[must_use]
    pub const fn blanes_casas_escorihuela_8() -> Self {
        Self { sums: PhantomData }
    }
}

/// a₁ … and b₁ …, the coefficients published; the last of each follows from the sums.
type Published = (&'static [f64], &'static [f64]);

const BLANES_MOAN_4: Published = {
    const A: [f64; 2] = [0.245_298_957_184_271, 0.604_872_665_711_080];
    const B: [f64; 3] = [0.082_984_406_417_405_2, 0.396_309_801_498_368, -0.039_056_304_922_348_6];
    (&[A[0], A[1], 0.5 - (A[0] + A[1])], &[B[0], B[1], B[2], 1.0 - 2.0 * (B[0] + B[1] + B[2])])
};

const BLANES_MOAN_6: Published = {
    const A: [f64; 5] = [
        0.123_229_775_946_271,
        0.290_553_797_799_558,
        -0.127_049_212_625_417,
        -0.246_331_761_062_075,
        0.357_208_872_795_928,
    ];
    const B: [f64; 5] = [
        0.041_464_998_518_262_4,
        0.198_128_671_918_067,
        -0.040_006_192_104_153_3,
        0.075_253_984_301_580_7,
        -0.011_511_387_420_687_9,
    ];
    (
        &[A[0], A[1], A[2], A[3], A[4], 1.0 - 2.0 * (A[0] + A[1] + A[2] + A[3] + A[4])],
        &[B[0], B[1], B[2], B[3], B[4], 0.5 - (B[0] + B[1] + B[2] + B[3] + B[4])],
    )
};

#[expect(clippy::excessive_precision, reason = "the digits published")]
const BLANES_CASAS_ESCORIHUELA_8: Published = {
    // The first two are the authors' choice, the others follow from the conditions.
    const A: [f64; 9] = [
        0.050_580_5,
        0.149_999,
        -0.055_179_551_077_161_557_351_102_695_036_1,
        0.423_755_898_835_337_951_482_264_998_051,
        -0.213_495_353_584_659_048_059_672_194_633,
        -0.068_076_977_457_403_261_911_163_073_627_4,
        0.227_917_056_974_013_435_948_887_201_671,
        -0.235_373_619_381_058_906_524_740_047_732,
        0.387_413_869_179_878_047_816_794_031_058,
    ];
    const B: [f64; 9] = [
        0.129_478_606_560_536_730_662_493_794_395,
        0.222_257_260_092_671_143_423_043_559_581,
        -0.057_751_489_332_514_720_475_702_324_632_0,
        -0.057_831_226_210_392_491_022_134_503_276_3,
        0.103_087_297_437_175_356_747_933_252_265,
        -0.140_819_612_554_090_768_205_554_103_887,
        0.023_446_260_349_282_627_669_971_371_862_6,
        0.134_854_517_356_684_096_617_882_205_068,
        0.028_797_382_107_377_930_634_517_216_021_1,
    ];
    const SUM_A: f64 = A[0] + A[1] + A[2] + A[3] + A[4] + A[5] + A[6] + A[7] + A[8];
    const SUM_B: f64 = B[0] + B[1] + B[2] + B[3] + B[4] + B[5] + B[6] + B[7] + B[8];
    (
        &[A[0], A[1], A[2], A[3], A[4], A[5], A[6], A[7], A[8], 0.5 - SUM_A],
        &[B[0], B[1], B[2], B[3], B[4], B[5], B[6], B[7], B[8], 1.0 - 2.0 * SUM_B],
    )
};

/// The first S of S + 1 shares that read the same from either end.
const fn outer<const S: usize>(half: &[f64]) -> [f64; S] {
    let mut shares = [0.0; S];
    let mut i = 0;
    while i < S {
        shares[i] = half[if i < half.len() { i } else { S - i }];
        i += 1;
    }
    shares
}

impl<const S: usize> Splitting<S> {
    const PUBLISHED: Published = match S {
        6 => BLANES_MOAN_4,
        11 => BLANES_MOAN_6,
        19 => BLANES_CASAS_ESCORIHUELA_8,
        _ => panic!("no such splitting is made"),
    };

    /// Whether a step begins and ends with a drift, else with a kick.
    pub(super) const DRIFTS_FIRST: bool = S == 19;
    pub(super) const DRIFTS: [f64; S] =
        if Self::DRIFTS_FIRST { outer(Self::PUBLISHED.0) } else { symmetric(Self::PUBLISHED.0) };
    pub(super) const KICKS: [f64; S] =
        if Self::DRIFTS_FIRST { symmetric(Self::PUBLISHED.1) } else { outer(Self::PUBLISHED.1) };

    /// a₁ + … + aᵢ: the share of the step that has passed after the i-th drift, when a kick follows.
    pub(super) const NODES: [f64; S] = {
        let mut nodes = [0.0; S];
        let mut passed = 0.0;
        let mut i = 0;
        while i < S {
            passed += Self::DRIFTS[i];
            nodes[i] = passed;
            i += 1;
        }
        if !Self::DRIFTS_FIRST {
            nodes[S - 1] = 1.0;
        }
        nodes
    };

    /// The kicks and drifts of a step in their order.
    pub(super) fn parts() -> impl Iterator<Item = Part> {
        (0..=2 * S).map(|i| {
            let number = i / 2 % S;
            if (i % 2 == 1) != Self::DRIFTS_FIRST {
                return Part::Drift(number);
            }
            let drifts = i.div_ceil(2);
            Part::Kick(number, if drifts == 0 { 0.0 } else { Self::NODES[drifts - 1] })
        })
    }

    /// How many gradients a step costs.
    pub(crate) const fn gradients(is_timed: bool) -> usize {
        if is_timed && !Self::DRIFTS_FIRST { S + 1 } else { S }
    }
}

impl<const S: usize, C: Sums> Splitting<S, C> {
    /// a₁ … a_S: the drifts as shares of the step; some are negative. They sum to 1, of order 8 with a₁ once
    /// more, for the drift after the last kick.
    #[must_use]
    pub const fn drifts(&self) -> &'static [f64; S] {
        &Splitting::<S>::DRIFTS
    }

    /// b₁ … b_S: the kicks as shares of the step. They sum to 1, of order 4 and 6 with b₁ once more, for the
    /// kick after the last drift.
    #[must_use]
    pub const fn kicks(&self) -> &'static [f64; S] {
        &Splitting::<S>::KICKS
    }

    /// The order p: on a fixed interval the error falls as h^p.
    #[must_use]
    pub const fn order(&self) -> u32 {
        match S {
            6 => 4,
            11 => 6,
            _ => 8,
        }
    }
}

/// Of a step, by its number.
pub(super) enum Part {
    /// With the share of the step that has passed.
    Kick(usize, f64),
    Drift(usize),
}
