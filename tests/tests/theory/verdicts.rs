//! No checker says yes to nonsense, and all of them follow the time.

mod poisoned;
mod poisoned_sections;
mod poisoned_steps;
mod random_samples;
mod register;
mod samples;
mod stopped;
mod time;
