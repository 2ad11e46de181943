//! Systems to try from Python, and those of the gallery.

mod blocks;
mod cart_pole;
mod double_pendulum;
mod henon_heiles;
mod oscillator;
mod ring;
mod rocket;
mod spherical_pendulum;

use blocks::Blocks;
use cart_pole::CartPole;
use dalembert_python::parameters;
use double_pendulum::DoublePendulum;
use henon_heiles::HenonHeiles;
use oscillator::ShakenOscillator;
use ring::Ring;
use rocket::Rocket;
use spherical_pendulum::SphericalPendulum;

dalembert_python::module!(dalembert_scenes {
    Ring,
    DoublePendulum,
    HenonHeiles,
    ShakenOscillator,
    CartPole,
    SphericalPendulum,
    Blocks,
    Rocket,
});
