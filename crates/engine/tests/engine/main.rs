//! Tests of whole runs through the public interface of the engine.
//!
//! One program for all of them: the engine is compiled for each kind of number once.

mod common;

mod augmented_lagrangian;
mod closed_form;
mod cold_starts;
mod convergence;
mod difficult_steps;
mod empty_ensemble;
mod energy_balance;
mod ensemble_shapes;
mod fans;
mod first_step;
mod golden;
mod halved_steps;
mod halving;
mod hysteresis;
mod large_zones;
mod levels;
mod linearly_implicit;
mod lone_surface;
mod long_walls;
mod marching;
mod nested_iteration;
mod order_with_windows;
mod overshoots;
mod periodic_start;
mod properties;
mod rooms_side_by_side;
mod single_precision;
mod slopes_of_stages;
mod step_lengths;
mod stepwise;
mod streamed;
mod supercooling;
mod tape_memory;
mod unlike_members;
mod vents;
mod wind;
mod windows;
mod zones;
