use anyhow::Result;

use crate::{rest, steps};

const HEAD: &str = "# Dry friction that holds

`rule = proximal` at random: written by `cargo study friction`, which takes some minutes; do not edit it.

**Sliders**: one to four masses, coupled by springs, dampers and their inertia, under constant forces, with up to five elements
μ|b·v − w| of dry friction: of a mass on the ground or on a belt, between two masses, or of any combination of velocities. On the
ground each mass has one, so that all come to rest.

**Beside it** a second program goes from event to event (`tests/src/sliders/events.rs`): between them the motion is linear, and a Taylor
series has it to rounding; which elements go on where slips are 0, the least of an objective over all 3^K ways says. It shares
nothing with the steps.

";

const READING: &str = "
- **Sliding** by constant friction is of order 2, the step in which an element stops or breaks loose of order 1. So one mass that slides to
  and fro and stops comes to rest at a place of order 2; several masses hand each other's stops on, and their places are of
  order 1.
- **The time of rest** is known to the step: a step stands as a whole, or it does not.
";

/// The page.
pub fn text() -> Result<String> {
    let mut text = String::from(HEAD);
    text += "## Where they come to rest\n\n";
    text += &rest::tables(500, 0)?;
    text += READING;
    text += "\n## Single steps\n\nv̄ is the least of ½vᵀMv − p·v + (h/2) Σ Fₖ|Bₖv|: five |·| in four coordinates against the least of all \
             243 ways to stick and to slide; a length of two components with two |·| by the gap to the dual problem.\n\n\
             | | steps | refused | with an element that sticks | largest excess, of 1 + the objective |\n|---|--:|--:|--:|--:|\n";
    for (name, tried, has_ball) in
        [("five \\|·\\|", 100_000, false), ("a length, two \\|·\\|", 100_000, true)]
    {
        let found = steps::least(tried, has_ball);
        text += &format!(
            "| {name} | {} | {} | {} | {:.0e} |\n",
            found.tried, found.refused, found.stuck, found.worst
        );
    }
    text += "\nWhere more elements stick than there are coordinates, or nearly so, their forces are not determined: some that hold are \
             taken.\n";
    let tried = 1000;
    let [below, above] = steps::at_the_edge(tried)?;
    text += &format!(
        "\n**At the edge**: of {tried} sliders at rest, friction from 0.1 to 10, under 1 − 10⁻¹² times the load that they hold {below} stand to the \
         last bit, under 1 + 10⁻¹² times it {above}.\n\n**Nothing creeps**: under nine tenths of it they have the same bits after {} steps.\n",
        steps::stands(10_000_000)?
    );
    Ok(text)
}
