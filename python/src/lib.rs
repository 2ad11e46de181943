//! Systems to try from Python, and those of the gallery.

mod cart_pole;
mod double_pendulum;
mod henon_heiles;
mod oscillator;
mod ring;

use cart_pole::{CartPole, DrivenCartPole};
use dalembert_python::parameters;
use double_pendulum::DoublePendulum;
use henon_heiles::HenonHeiles;
use oscillator::{ShakenOscillator, ShakenOscillatorAtTime};
use ring::Ring;

dalembert_python::module!(dalembert_scenes {
    Ring,
    DoublePendulum { parameters: 2 },
    HenonHeiles,
    ShakenOscillator { at_time: ShakenOscillatorAtTime, parameters: 3 },
    CartPole { driven: DrivenCartPole, inputs: 1 },
});
