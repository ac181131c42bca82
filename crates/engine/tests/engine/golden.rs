//! Hashes of whole runs: a change of the code that keeps every bit keeps all of them.
//!
//! A row of a table has the name of a case and two hashes. The first is of its answers: records, ledger, slopes, matrices,
//! and how often the first period was repeated. The second is of the rest: the state at the end, the counters of the
//! solver and the members that failed. Where answers change on purpose, run the tests and put the tables that they print
//! in the place of the old ones.

use core::fmt::Write as _;
use std::process::Command;

use crate::common::assorted::{assorted_cell, assorted_weather, assorted_windows};
use crate::common::conditioned::{conditioned, conditioned_probes, conditioned_weather, ideal_load};
use crate::common::glazed::{glazed_probes, glazed_rooms};
use crate::common::linear::{cell_of_linear_laws, linear_cell};
use crate::common::melting::{ceiling_weather, fine_ceiling, melting, melting_weather};
use crate::common::{
    SCHEMES, cell, cell_members, cell_probes, cell_weather, forcing, options, values, weather,
};
use mascarin_engine::batch::ensemble;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::description::{Description, HysteresisModel};
use mascarin_engine::dispatch::Level;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::march::Scheme;
use mascarin_engine::march::{Options, Run, Warmup, Watch, march};
use mascarin_engine::plan::Plan;
use mascarin_engine::probe::Probe;
use mascarin_engine::real::{Dual, Lanes, Mask, Real};
use mascarin_engine::state::Initial;
use mascarin_engine::state_space::state_space;
use rayon::prelude::*;

#[rustfmt::skip]
const RUNS: &[(&str, [u64; 2])] = &[
    ("cell, Sdirk2, 1 slope", [0xb34b644bf62955a0, 0x99e15442217c0eb5]),
    ("cell, Sdirk2, 8 slopes", [0x6f94f9ef1a506fc3, 0x9edbc867b8390412]),
    ("cell, Sdirk2, jacobian", [0x86060cb90d0f2e46, 0x0000000000000000]),
    ("cell, Sdirk2, gradient, all kept", [0x8d54a2464f68bc57, 0xc7a88d425dc407a9]),
    ("cell, Sdirk2, gradient, some kept", [0x8d54a2464f68bc57, 0xc7a88d425dc407a9]),
    ("cell, ApparentCapacity, 1 slope", [0x309cf8c9963e2a76, 0x31437ae3f6f26911]),
    ("cell, ApparentCapacity, 8 slopes", [0x1849bf09db3eac1f, 0xd3283e48f043831b]),
    ("cell, ApparentCapacity, jacobian", [0xf8c568994f3a8d87, 0x0000000000000000]),
    ("cell, ApparentCapacity, gradient, all kept", [0xbd8e00a466b19112, 0x5fd2ae9c6ddc769a]),
    ("cell, ApparentCapacity, gradient, some kept", [0xbd8e00a466b19112, 0x5fd2ae9c6ddc769a]),
    ("cell of linear laws, BackwardEuler, 1 slope", [0x5ac7a65820f05bf6, 0x4101cb235bdfd58e]),
    ("cell of linear laws, BackwardEuler, 8 slopes", [0x65941da10bf11e99, 0x714929d6c2fdc179]),
    ("cell of linear laws, BackwardEuler, jacobian", [0xe1222856054a3a27, 0x0000000000000000]),
    ("cell of linear laws, BackwardEuler, gradient, all kept", [0xa8f43c27395240d4, 0x52c93ccca8adde2a]),
    ("cell of linear laws, BackwardEuler, gradient, some kept", [0xa8f43c27395240d4, 0x52c93ccca8adde2a]),
    ("conditioned cell, Sdirk2, 1 slope", [0xc7650169433bcc6e, 0x6d57fc75f57aac08]),
    ("conditioned cell, Sdirk2, 8 slopes", [0x3358d94cf22d90de, 0xb5f174740c510573]),
    ("conditioned cell, Sdirk2, jacobian", [0xa010242091f03c02, 0x0000000000000000]),
    ("conditioned cell, Sdirk2, gradient, all kept", [0x857ca2507f74aaec, 0x8acf0585c7d6e8fd]),
    ("conditioned cell, Sdirk2, gradient, some kept", [0x857ca2507f74aaec, 0x8acf0585c7d6e8fd]),
    ("conditioned cell, BackwardEuler, 1 slope", [0xdc4a9ee2e9539e06, 0x822036e9e1887ee3]),
    ("conditioned cell, BackwardEuler, 8 slopes", [0x04faa28daa92d56f, 0xff4415a6201b24b4]),
    ("conditioned cell, BackwardEuler, jacobian", [0xb8e2bee55ff95ba0, 0x0000000000000000]),
    ("conditioned cell, BackwardEuler, gradient, all kept", [0x4fe3e5787ba4b84a, 0xb6e57e16c11c2874]),
    ("conditioned cell, BackwardEuler, gradient, some kept", [0x4fe3e5787ba4b84a, 0xb6e57e16c11c2874]),
    ("glazed room, sun by area, Sdirk2, 1 slope", [0xa900b9dec4bc1beb, 0x971d6df4d85a5c1f]),
    ("glazed room, sun by area, Sdirk2, 8 slopes", [0x08d8af27b18d1e6d, 0x375757ab8e940cfd]),
    ("glazed room, sun by area, Sdirk2, jacobian", [0x5d8a7792ba4ac405, 0x0000000000000000]),
    ("glazed room, sun by area, Sdirk2, gradient, all kept", [0x860e86589d194eea, 0x6119600e6d2840d0]),
    ("glazed room, sun by area, Sdirk2, gradient, some kept", [0x860e86589d194eea, 0x6119600e6d2840d0]),
    ("glazed room, sun by geometry, BackwardEuler, 1 slope", [0x19f189d78d996c70, 0xbd8ef0acc6976b48]),
    ("glazed room, sun by geometry, BackwardEuler, 8 slopes", [0xd97bee1480a72ee8, 0x6ca2e5d64e7142b1]),
    ("glazed room, sun by geometry, BackwardEuler, jacobian", [0x386a545275fc6b88, 0x0000000000000000]),
    ("glazed room, sun by geometry, BackwardEuler, gradient, all kept", [0x3c34adc8f560e6b5, 0xaacbe8a05fb38465]),
    ("glazed room, sun by geometry, BackwardEuler, gradient, some kept", [0x3c34adc8f560e6b5, 0xaacbe8a05fb38465]),
    ("curve track, BackwardEuler, 1 slope", [0xb11ec1ce79397938, 0x89550886b604d86c]),
    ("curve track, BackwardEuler, jacobian", [0x5d6300cb705e4513, 0x0000000000000000]),
    ("curve track, BackwardEuler, gradient, all kept", [0x6936871f2ed25ec8, 0x58d64f1ffcf0b7df]),
    ("curve track, BackwardEuler, gradient, some kept", [0x6936871f2ed25ec8, 0x58d64f1ffcf0b7df]),
    ("curve switch, Sdirk2, 1 slope", [0x30c4a3eea2a30bb5, 0x1b58e254e503ce27]),
    ("curve switch, Sdirk2, jacobian", [0xe3857e1d902d68e7, 0x0000000000000000]),
    ("curve switch, Sdirk2, gradient, all kept", [0x41f4451e377d366a, 0x866955a643241016]),
    ("curve switch, Sdirk2, gradient, some kept", [0x41f4451e377d366a, 0x866955a643241016]),
    ("curve scale, Sdirk2, 1 slope", [0x697962b221d15975, 0x33c8615ed9b8c0fb]),
    ("curve scale, Sdirk2, jacobian", [0xb7352a6f5d1289a1, 0x0000000000000000]),
    ("curve scale, Sdirk2, gradient, all kept", [0x5c2aa94672d3d4d6, 0xb58664386bb3af67]),
    ("curve scale, Sdirk2, gradient, some kept", [0x5c2aa94672d3d4d6, 0xb58664386bb3af67]),
    ("assorted cell, measured sky, Sdirk2, 1 slope", [0x106f90e473b0cec9, 0x09bc6e9d2c7e061b]),
    ("assorted cell, measured sky, Sdirk2, 8 slopes", [0x6873416a2c52e9ff, 0x5dd4e3415d040517]),
    ("assorted cell, measured sky, Sdirk2, jacobian", [0xb455f772db1d9cb9, 0x0000000000000000]),
    ("assorted cell, measured sky, Sdirk2, gradient, all kept", [0x237ee24095637ddd, 0x5780af2111903f9f]),
    ("assorted cell, measured sky, Sdirk2, gradient, some kept", [0x237ee24095637ddd, 0x5780af2111903f9f]),
    ("assorted windows, Sdirk2, 1 slope", [0x0a78722f38db95c8, 0x8c1a016b98708770]),
    ("assorted windows, Sdirk2, 8 slopes", [0xd3346ef9034d5b07, 0x94559fec5e5e9ec5]),
    ("assorted windows, Sdirk2, jacobian", [0x1c09aededbb5b195, 0x0000000000000000]),
    ("assorted windows, Sdirk2, gradient, all kept", [0x7a479e51d6bf06e8, 0x6de7f63754c9098c]),
    ("assorted windows, Sdirk2, gradient, some kept", [0x7a479e51d6bf06e8, 0x6de7f63754c9098c]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, 1 slope", [0xaa9f7d7b44116d5c, 0x512d6b9eacff1ddd]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, 8 slopes", [0xbfce8c0e2662a96e, 0x49ffa9c3d7321143]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, jacobian", [0xed567284b956dadf, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, gradient, all kept", [0x8afba36908f04cee, 0x5f8eeb0b6778609f]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, gradient, some kept", [0x8afba36908f04cee, 0x5f8eeb0b6778609f]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, 1 slope", [0x2fcc0fef742e7084, 0x5f85a02344f8509d]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, 8 slopes", [0x92ccfb63c593819b, 0xc25c18ba51f399c4]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, jacobian", [0x3b6cbf7e3b0c5c86, 0x0000000000000000]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, gradient, all kept", [0x1955c2f960b3c53c, 0x304717f282b7134d]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, gradient, some kept", [0x1955c2f960b3c53c, 0x304717f282b7134d]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, 1 slope", [0x189bdb3061ea0f59, 0x1bde089cb5dc2069]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, jacobian", [0x58930a3e25cbcbea, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, gradient, all kept", [0x2e99edee7c641bac, 0x1ca9773be302d0b7]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, gradient, some kept", [0x2e99edee7c641bac, 0x1ca9773be302d0b7]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, 1 slope", [0x1faec26acadf38c7, 0x7b63af0242e78637]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, 8 slopes", [0xd65081c44afcb682, 0x8dd486cfcf9f0f0d]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, jacobian", [0xee42122a5e4a2a13, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, gradient, all kept", [0xdd18d41350491c12, 0xf6d894184035de7a]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, gradient, some kept", [0xdd18d41350491c12, 0xf6d894184035de7a]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, 1 slope", [0x88c37e8bb6a93f43, 0xd2de802168e3c55c]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, jacobian", [0xc72ee397d5e0daa4, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, gradient, all kept", [0x40de756ec769950d, 0x81739e668226795a]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, gradient, some kept", [0x40de756ec769950d, 0x81739e668226795a]),
    ("linear cell, matrices", [0x8e8acf1d22451ddf, 0x7ad8fdbd070e8ad0]),
    ("cell, BackwardEuler, 4 lanes", [0xde66d50fbbd91cbe, 0xb308ebc662e3aafb]),
    ("cell, Sdirk2, 8 lanes", [0xcd3e0afaf9d93333, 0xff6d0f8901cee2b0]),
    ("cell, ApparentCapacity, 8 lanes", [0x95293a3fb6fd3ada, 0xf31bd8ecde063380]),
    ("cell of linear laws, Sdirk2, 4 lanes", [0xeca873efe2df6b44, 0xec072ecf79767453]),
    ("cell of linear laws, BackwardEuler, 8 lanes", [0x65e0fbd73111739e, 0xea929d921d8a0d46]),
    ("conditioned cell, Sdirk2, 4 lanes", [0x90c9df22878dc213, 0xe25dde5b938f68cf]),
    ("conditioned cell, BackwardEuler, 8 lanes", [0xe6a8cbc2c22c39d3, 0xebf06e669468e1b2]),
    ("glazed room, sun by geometry, Sdirk2, 4 lanes", [0x98ccb91628562d60, 0x0c69e83382887336]),
    ("glazed room, sun by geometry, BackwardEuler, 8 lanes", [0xb67e728a388f1af0, 0xb6b5f8c15b5cfcd4]),
    ("curve scale, Sdirk2, 4 lanes", [0x1ef6d35735cf3ae5, 0x7bd4ebeb618e2261]),
    ("curve scale, BackwardEuler, 8 lanes", [0x93d7362bcbc3b818, 0xc9f895e1b984a279]),
    ("cell, Sdirk2", [0x8c33a4fcb950429e, 0x759b006579e570dc]),
    ("cell, BackwardEuler", [0xa3079958295fd047, 0x9b7a95ec12ba582a]),
    ("cell, ApparentCapacity", [0x987d1abe085ae0bc, 0x8286f941cef7c611]),
    ("cell of linear laws, Sdirk2", [0xf96f4921f0b97c5c, 0x099f72c759eb3468]),
    ("cell of linear laws, BackwardEuler", [0xd6bf57bfb630885d, 0x1244f233a4312e92]),
    ("cell of linear laws, ApparentCapacity", [0x1fef07ba1c2c70bb, 0x47e9e83f72e4afff]),
    ("linear cell, Sdirk2", [0xc7dd24357d740877, 0xc5d019364886e339]),
    ("linear cell, BackwardEuler", [0x35336da8f3954138, 0x14df62cea03d73e7]),
    ("linear cell, ApparentCapacity", [0x35336da8f3954138, 0x14df62cea03d73e7]),
    ("conditioned cell, Sdirk2", [0xef033bb2b9b20585, 0x6aa89b67ee9f3944]),
    ("conditioned cell, BackwardEuler", [0x1d5a4e7399ec30ce, 0x91b40e8e29cdc2d5]),
    ("conditioned cell, ApparentCapacity", [0x04c01d3e4f87c86e, 0x7ad094690118bcb9]),
    ("glazed room, sun by area, Sdirk2", [0x3b351fecbbdd045a, 0xb3d02cf10f3fe201]),
    ("glazed room, sun by area, BackwardEuler", [0x99a62a8e07d83edc, 0x241684c5682aab3e]),
    ("glazed room, sun by area, ApparentCapacity", [0x99a62a8e07d83edc, 0x241684c5682aab3e]),
    ("glazed room, sun by shares, Sdirk2", [0xe3e895608b9c753d, 0x9765ddc1b2aebb23]),
    ("glazed room, sun by shares, BackwardEuler", [0x4b59020669e32ae4, 0x76d53f3944e3b752]),
    ("glazed room, sun by shares, ApparentCapacity", [0x4b59020669e32ae4, 0x76d53f3944e3b752]),
    ("glazed room, sun by geometry, Sdirk2", [0x81f764d9b68ba1a8, 0x653b4112624c21d4]),
    ("glazed room, sun by geometry, BackwardEuler", [0xcc1204afed670b2a, 0x02974a625d2e3dfd]),
    ("glazed room, sun by geometry, ApparentCapacity", [0xcc1204afed670b2a, 0x02974a625d2e3dfd]),
    ("melting, Sdirk2", [0x2da9e08095ae4df3, 0xb6503d47b11943b4]),
    ("melting, BackwardEuler", [0x957b1145434b9728, 0x01455d25ba4f7efd]),
    ("melting, ApparentCapacity", [0x2fe90e1b8afafcfe, 0x48f57cd7ab67135b]),
    ("curve track, Sdirk2", [0x47b489d5b8d3502f, 0x1ea6b2ad6a9adb2b]),
    ("curve track, BackwardEuler", [0xe1ff9ad4b6124cd5, 0x1fb30ab30ce988ce]),
    ("curve track, ApparentCapacity", [0x14d25fe460219eac, 0x1a1861913d724caa]),
    ("curve switch, Sdirk2", [0xbc7ee1c6cb896fcc, 0x6c621dd777d87092]),
    ("curve switch, BackwardEuler", [0xb34e710ea582719c, 0x138470997bf8c051]),
    ("curve switch, ApparentCapacity", [0x131dcca6d9e248c1, 0xd03152117cd1208b]),
    ("curve scale, Sdirk2", [0x7abf84cb7b569fcd, 0x8632e4b5a67bf34d]),
    ("curve scale, BackwardEuler", [0x4f2dd24b4149b1ef, 0x4c4649c30b88ac31]),
    ("curve scale, ApparentCapacity", [0x2753f454abed3e6a, 0x19d9db10ba1a32aa]),
    ("assorted cell, measured sky, Sdirk2", [0x3f1e1d53c3f5b663, 0x4470822b8a7620bb]),
    ("assorted cell, measured sky, BackwardEuler", [0x933d3214282b1eb2, 0xbcf25d48c2390a4e]),
    ("assorted cell, measured sky, ApparentCapacity", [0xdb8ab5c185a81ef6, 0x22f285898f37b7a4]),
    ("assorted cell, Clark and Allen, Sdirk2", [0x5946688c52138e60, 0xa6635d96bfcabe23]),
    ("assorted cell, Clark and Allen, BackwardEuler", [0xa3d7cd63e3792313, 0x30a45a7d7c219891]),
    ("assorted cell, Clark and Allen, ApparentCapacity", [0x95884e288852d0d8, 0xdf23597837ef17a8]),
    ("assorted cell, Brunt, Sdirk2", [0x05bb92c6db6e43c3, 0x82a35f6ee0c5dc2f]),
    ("assorted cell, Brunt, BackwardEuler", [0x40e74417043339e3, 0x8f52b3f382f18678]),
    ("assorted cell, Brunt, ApparentCapacity", [0xd59455cf4b11382a, 0x7eecd33d1f044302]),
    ("assorted cell, offset, Sdirk2", [0x1d1f5594008566af, 0xc59bd7568c881c17]),
    ("assorted cell, offset, BackwardEuler", [0x2f8bd8fb5a77c1b4, 0x9e2c6618f3309b59]),
    ("assorted cell, offset, ApparentCapacity", [0x2f6f8f7e8f575a23, 0x4ba46458bf68fdcf]),
    ("assorted windows, Sdirk2", [0xfcfe79fcda8b2b96, 0x323c2912de733fd6]),
    ("assorted windows, BackwardEuler", [0x9d4870f4e045684b, 0x9dcf8ab453f7dee8]),
    ("assorted windows, ApparentCapacity", [0x9d4870f4e045684b, 0x9dcf8ab453f7dee8]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler", [0x0440b01401e0c8f3, 0x5f8eeb0b6778609f]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler", [0xc064b120f970a248, 0x304717f282b7134d]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2", [0xe869535ffdb2cbb1, 0x1ca9773be302d0b7]),
    ("ceiling of gamma 100 in 40 nodes, Sdirk2", [0xb15e1f061931e003, 0x731eb512f765aa08]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler", [0x278232dc8e489ea4, 0xb50f1db9219cbed7]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2", [0xc57ebdadcee5dfc9, 0x6661db49e0fac31e]),
    ("ceiling of gamma 1000 in 80 nodes with ideal loads, BackwardEuler", [0x2e7786f19309ff3b, 0x28dc99314167e063]),
    ("cell from given temperatures", [0x71d883b8a3408dfe, 0x5266e840b7dc7854]),
];

#[rustfmt::skip]
const ENSEMBLES: &[(&str, [u64; 2])] = &[
    ("cell, Sdirk2, ensemble", [0x7f448f8cc295c07b, 0x2cdcdc0dfc5d1141]),
    ("cell of linear laws, Sdirk2, ensemble", [0xbececb584774e332, 0x2cdcdc0dfc5d1141]),
    ("conditioned cell, Sdirk2, ensemble", [0xf3f1f621d4578fa6, 0x2cdcdc0dfc5d1141]),
    ("glazed room, sun by geometry, Sdirk2, ensemble", [0xf42ecf01d4a1403d, 0x2cdcdc0dfc5d1141]),
    ("curve scale, Sdirk2, ensemble", [0xb91b507706e22b11, 0x2cdcdc0dfc5d1141]),
    ("cell, BackwardEuler, ensemble", [0x588a7ea4707b8588, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, ensemble", [0x58939416bcb3d741, 0xcbf29ce484222325]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, ensemble", [0x7aa2c2b0328772dd, 0xcbf29ce484222325]),
    ("ceiling of gamma 100 in 40 nodes, Sdirk2, ensemble", [0x9bcc858e5de93fee, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, ensemble", [0x806512a70aa64e85, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 80 nodes with ideal loads, BackwardEuler, ensemble", [0xba01c7d7041e028b, 0xcbf29ce484222325]),
];

const STEP: f64 = 900.0;
const HOUR: f64 = 3600.0;

// ---------------------------------------------------------------- hashes

/// FNV-1a of 64 bits (Fowler, Noll, Vo; RFC 9923).
#[derive(Clone, Copy)]
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf29ce484222325)
    }

    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100000001b3);
        }
    }

    fn count(&mut self, count: usize) {
        self.bytes(&(count as u64).to_le_bytes());
    }

    /// The bits of a number; what is not a number has no bits of its own.
    fn number(&mut self, number: f64) {
        let number = if number.is_nan() { f64::NAN } else { number };
        self.bytes(&number.to_bits().to_le_bytes());
    }

    /// The count of some numbers and their bits.
    fn numbers(&mut self, numbers: &[f64]) {
        self.count(numbers.len());
        for &number in numbers {
            self.number(number);
        }
    }

    /// The count of some numbers, and the values and slopes of all lanes that have not failed.
    fn lanes<S: Sloped>(&mut self, numbers: &[S], failed: S::Mask) {
        self.count(numbers.len());
        for number in numbers {
            for lane in (0..S::LANES).filter(|&lane| !failed.lane(lane)) {
                self.number(number.lane(lane));
            }
            number.slopes().iter().for_each(|&slope| self.number(slope));
        }
    }
}

/// A kind of numbers, and what it carries beside the value.
trait Sloped: Real {
    fn slopes(&self) -> &[f64] {
        &[]
    }
}
impl Sloped for f64 {}
impl<const N: usize> Sloped for Lanes<N> {}
impl<const K: usize> Sloped for Dual<K> {
    fn slopes(&self) -> &[f64] {
        &self.slope
    }
}

/// Name of a case, and the hashes of its answers and of the rest.
struct Row(String, [u64; 2]);

/// The hashes of a run.
fn hashed<S: Sloped>(name: &str, run: &Run<S>) -> Row {
    let failed = run.failed;
    let (mut answers, mut rest) = (Hash::new(), Hash::new());
    answers.lanes(&run.records, failed);
    answers.lanes(&run.ledger.into, failed);
    answers.lanes(&[run.ledger.stored, run.ledger.total_exchanged, run.ledger.imbalance], failed);
    answers.count(run.cycles);
    for numbers in
        [&run.state.cells[..], &run.state.enthalpy, &run.state.surfaces, &run.state.air, &run.state.load]
    {
        rest.lanes(numbers, failed);
    }
    for memory in &run.state.memory {
        let [first, second] = memory.marks;
        rest.lanes(&[memory.liquid_fraction, memory.temperature, first, second], failed);
    }
    rest.lanes(&[run.warm_up_change, run.counters.reversals], failed);
    for count in [run.counters.iterations, run.counters.nested, run.counters.halvings] {
        rest.count(count);
    }
    (0..S::LANES).for_each(|lane| rest.count(usize::from(failed.lane(lane))));
    Row(name.to_owned(), [answers.0, rest.0])
}

// ---------------------------------------------------------------- cases

/// A building, its weather, and what is read of it.
struct Sample {
    name: String,
    plan: Plan,
    weather: fn(f64, &mut [f64]),
    /// Time of the weather at the start [h].
    start: f64,
    steps: usize,
    probes: Vec<Probe>,
    /// Whether the first hours are repeated until their end is their start.
    warm_up: bool,
}

impl Sample {
    /// From the morning to the evening.
    fn new(name: &str, description: Description, weather: fn(f64, &mut [f64]), probes: Vec<Probe>) -> Self {
        let plan = Plan::new(description).unwrap();
        Self { name: name.to_owned(), plan, weather, start: 7.0, steps: 40, probes, warm_up: false }
    }

    fn cell() -> Self {
        Self { warm_up: true, ..Self::new("cell", cell(0.04), cell_weather, every(cell_probes())) }
    }

    fn linear_laws() -> Self {
        Self::new("cell of linear laws", cell_of_linear_laws(false), cell_weather, cell_probes())
    }

    fn linear() -> Self {
        let probes = [0, 1].map(|zone| Probe::AirTemperature { zone }).to_vec();
        Self::new("linear cell", linear_cell(), cell_weather, probes)
    }

    /// From the night to the afternoon: heating and cooling both run.
    fn conditioned() -> Self {
        let sample =
            Self::new("conditioned cell", conditioned(0.04), conditioned_weather, conditioned_probes());
        Self { start: 2.0, steps: 56, ..sample }
    }

    /// The room with windows, by each law of where the sun lands.
    fn glazed() -> [Self; 3] {
        let names = ["sun by area", "sun by shares", "sun by geometry"];
        let mut rooms = glazed_rooms().into_iter();
        names.map(|name| {
            Self::new(&format!("glazed room, {name}"), rooms.next().unwrap(), weather, glazed_probes())
        })
    }

    /// All shapes of melting curves, without hysteresis and with each model of it.
    fn melting() -> [Self; 4] {
        [
            ("melting", None),
            ("curve track", Some(HysteresisModel::CurveTrack)),
            ("curve switch", Some(HysteresisModel::CurveSwitch)),
            ("curve scale", Some(HysteresisModel::CurveScale)),
        ]
        .map(|(name, model)| {
            let description = melting(model);
            let mut probes = vec![Probe::AirTemperature { zone: 0 }];
            for surface in 0..description.surfaces.len() {
                probes.push(Probe::LiquidFraction { surface, layer: 0 });
                probes.push(Probe::LayerEnthalpy { surface, layer: 0 });
            }
            Self { start: 0.0, steps: 48, ..Self::new(name, description, melting_weather, probes) }
        })
    }

    /// Sharp melting in a number of nodes under a heat transfer coefficient [W/(m2 K)], with or without ideal loads. From this hour on
    /// Newton's iteration fails within so many steps, but for the last four.
    fn sharp([gamma, coefficient, start]: [f64; 3], nodes: usize, ideal_loads: bool, steps: usize) -> Self {
        let mut d = fine_ceiling(gamma, nodes, coefficient);
        if ideal_loads {
            d.zones[0].heating = Some(ideal_load(&mut d, "room.heating", 22.0, 300.0));
            d.zones[0].cooling = Some(ideal_load(&mut d, "room.cooling", 24.0, 80.0));
        }
        let probes = vec![
            Probe::AirTemperature { zone: 0 },
            Probe::LiquidFraction { surface: 0, layer: 0 },
            Probe::FaceFlux { surface: 0, side: 1 },
            Probe::CoolingLoad { zone: 0 },
        ];
        let loads = if ideal_loads { " with ideal loads" } else { "" };
        let name = format!("ceiling of gamma {gamma} in {nodes} nodes{loads}");
        Self { start, steps, ..Self::new(&name, d, ceiling_weather, probes) }
    }

    fn assorted() -> [Self; 5] {
        let cell = |sky: &str, which| {
            let name = format!("assorted cell, {sky}");
            Self::new(&name, assorted_cell(which), assorted_weather, every(conditioned_probes()))
        };
        [
            cell("measured sky", 0),
            cell("Clark and Allen", 1),
            cell("Brunt", 2),
            cell("offset", 3),
            Self::new("assorted windows", assorted_windows(), weather, glazed_probes()),
        ]
    }

    fn options(&self, scheme: Scheme) -> Options {
        let warmup = self.warm_up.then_some(Warmup { steps: 12, tolerance: 0.2, max_cycles: 200 });
        Options { warmup, ..options(scheme, STEP, self.probes.clone()) }
    }

    fn rows(&self, scheme: Scheme) -> Vec<f64> {
        let weather = |time, row: &mut [f64]| (self.weather)(self.start * HOUR + time, row);
        forcing(&self.plan, scheme, self.steps, STEP, weather)
    }

    fn drive<'a>(&self, rows: &'a [f64], scheme: Scheme) -> Forcing<'a> {
        Forcing::new(rows, scheme.weights().len(), self.plan.n_channels()).unwrap()
    }

    /// A run with any kind of numbers.
    fn run<S: Sloped>(&self, numbers: &[S], options: &Options) -> Run<S> {
        let rows = self.rows(options.scheme);
        let drive = self.drive(&rows, options.scheme);
        march(&self.plan, numbers, &drive, options, &Watch::default()).unwrap()
    }

    /// Whether it is small enough for what takes long.
    fn small(&self) -> bool {
        self.plan.n_cells < 40
    }

    /// Members that differ in their materials, heat transfer coefficients and powers.
    fn members(&self, count: usize) -> Vec<Vec<f64>> {
        let varied = ["conductivity", "density", "latent_heat", "coefficient", "power", "width", "factor"];
        let parameters = self.plan.description.parameters.iter();
        let varied: Vec<bool> = parameters
            .map(|parameter| varied.iter().any(|leaf| parameter.path.split('.').any(|part| part == *leaf)))
            .collect();
        (0..count)
            .map(|member| {
                let number = |(index, value): (usize, f64)| {
                    let by =
                        if varied[index] { 0.1 * Real::sin(1.3 * member as f64 + index as f64) } else { 0.0 };
                    value * (1.0 + by)
                };
                values(&self.plan).into_iter().enumerate().map(number).collect()
            })
            .collect()
    }

    /// Members side by side in lanes.
    fn in_lanes<const N: usize>(&self, members: &[Vec<f64>]) -> Vec<Lanes<N>> {
        let width = self.plan.description.parameters.len();
        (0..width).map(|p| Lanes(core::array::from_fn(|lane| members[lane][p]))).collect()
    }

    /// Parameters spread evenly over the list.
    fn spread(&self, count: usize) -> Vec<usize> {
        let all = self.plan.description.parameters.len();
        (0..count).map(|k| k * all / count + all / (2 * count)).collect()
    }

    /// The nominal values with slopes by as many parameters.
    fn sloped<const K: usize>(&self) -> Vec<Dual<K>> {
        let mut duals: Vec<Dual<K>> = values(&self.plan).into_iter().map(Dual::constant).collect();
        for (which, parameter) in self.spread(K).into_iter().enumerate() {
            duals[parameter].slope[which] = 1.0;
        }
        duals
    }
}

/// Readings, and those that no other sample has.
fn every(mut probes: Vec<Probe>) -> Vec<Probe> {
    probes.push(Probe::LayerTemperature { surface: 4, layer: 0 });
    probes.push(Probe::IncidentSolar { surface: 0 });
    probes.push(Probe::SkyTemperature);
    probes
}

// ---------------------------------------------------------------- groups of cases

/// What Newton's iteration does in a sharp sample.
#[derive(Debug, PartialEq)]
enum Fails {
    /// The nested iteration solves a stage.
    Nested,
    /// A step is halved.
    Halved,
}

/// Samples and schemes in which Newton's iteration fails.
fn hard() -> Vec<(Sample, Scheme, Fails)> {
    use Fails::{Halved, Nested};
    use Scheme::{BackwardEuler, Sdirk2};
    vec![
        (Sample::sharp([1000.0, 25.0, 16.0], 10, false, 36), BackwardEuler, Nested),
        (Sample::sharp([300.0, 10.0, 18.0], 20, false, 28), BackwardEuler, Halved),
        (Sample::sharp([1000.0, 25.0, 88.0], 40, false, 36), Sdirk2, Nested),
        (Sample::sharp([100.0, 25.0, 40.0], 40, false, 36), Sdirk2, Halved),
        (Sample::sharp([1000.0, 25.0, 20.0], 20, true, 20), BackwardEuler, Nested),
        (Sample::sharp([1000.0, 25.0, 20.0], 40, true, 20), Sdirk2, Nested),
        (Sample::sharp([1000.0, 25.0, 20.0], 80, true, 21), BackwardEuler, Halved),
    ]
}

/// Runs of plain numbers.
fn plain() -> Vec<Row> {
    let mut samples = vec![Sample::cell(), Sample::linear_laws(), Sample::linear(), Sample::conditioned()];
    samples.extend(Sample::glazed());
    samples.extend(Sample::melting());
    samples.extend(Sample::assorted());
    let with_schemes = samples.par_iter().flat_map_iter(|sample| {
        SCHEMES.map(|scheme| {
            let name = format!("{}, {scheme:?}", sample.name);
            let run = sample.run(&values(&sample.plan), &sample.options(scheme));
            assert!(!sample.warm_up || run.cycles > 1, "{name}: the first hours are repeated");
            let turns = sample.name == "curve switch" && scheme == Scheme::Sdirk2;
            assert!(!turns || run.counters.reversals > 0.0, "{name}: melting turns within a step");
            hashed(&name, &run)
        })
    });
    let mut rows: Vec<Row> = with_schemes.collect();
    rows.par_extend(hard().into_par_iter().map(|(sample, scheme, fails)| {
        let name = format!("{}, {scheme:?}", sample.name);
        let run = sample.run(&values(&sample.plan), &sample.options(scheme));
        // Where the inner iteration does not converge, the step is halved: its conductivity changes as steeply as its enthalpy.
        let halved = run.counters.halvings > 0;
        let reached = halved || (fails == Fails::Nested && run.counters.nested > 0);
        assert!(reached, "{name}: expected {fails:?}, found {:?}", run.counters);
        hashed(&name, &run)
    }));
    let sample = Sample { warm_up: false, ..Sample::cell() };
    let count = |count: usize, from: f64| (0..count).map(|k| from + 0.1 * k as f64).collect();
    let initial = Initial::Given {
        cells: count(sample.plan.n_cells, 20.0),
        surfaces: count(sample.plan.surfaces.len(), 19.0),
        air: count(sample.plan.zones.len(), 23.0),
    };
    let options = Options { initial, record_from: 10, record_every: 4, ..sample.options(Scheme::Sdirk2) };
    rows.push(hashed("cell from given temperatures", &sample.run(&values(&sample.plan), &options)));
    rows
}

/// Runs of members side by side in arrays.
fn lanes() -> Vec<Row> {
    fn one<const N: usize>(sample: &Sample, members: &[Vec<f64>], scheme: Scheme) -> Row {
        let run = sample.run(&sample.in_lanes::<N>(members), &sample.options(scheme));
        hashed(&format!("{}, {scheme:?}, {N} lanes", sample.name), &run)
    }
    let cell = Sample { steps: 16, ..Sample::cell() };
    let numbers = cell_members(&cell.plan, 8);
    let members: Vec<_> =
        numbers.chunks(cell.plan.description.parameters.len()).map(<[f64]>::to_vec).collect();
    let mut rows = vec![
        one::<4>(&cell, &members, Scheme::BackwardEuler),
        one::<8>(&cell, &members, Scheme::Sdirk2),
        one::<8>(&cell, &members, Scheme::ApparentCapacity),
    ];
    let [.., glazed] = Sample::glazed();
    let [.., scale] = Sample::melting();
    let others = [Sample::linear_laws(), Sample::conditioned(), glazed, scale];
    rows.par_extend(others.into_par_iter().flat_map_iter(|sample| {
        let sample = Sample { steps: 24, ..sample };
        let members = sample.members(8);
        [one::<4>(&sample, &members, Scheme::Sdirk2), one::<8>(&sample, &members, Scheme::BackwardEuler)]
    }));
    rows
}

/// Ensembles: a whole pack, and a part of one. A member at no number fails; those that Newton's iteration cannot solve in
/// lanes are run alone.
fn ensembles() -> Vec<Row> {
    let [.., glazed] = Sample::glazed();
    let [.., scale] = Sample::melting();
    let samples = [Sample::cell(), Sample::linear_laws(), Sample::conditioned(), glazed, scale];
    let mut all: Vec<_> = samples.map(|sample| (Sample { steps: 12, ..sample }, Scheme::Sdirk2, 10)).into();
    all.push((Sample { steps: 12, ..Sample::cell() }, Scheme::BackwardEuler, 3));
    let hard = hard().into_iter().filter(|(sample, _, fails)| sample.small() || *fails == Fails::Halved);
    all.extend(hard.map(|(sample, scheme, _)| (sample, scheme, 2)));
    let rows = all.par_iter().map(|(sample, scheme, count)| {
        let mut members = sample.members(*count);
        members[1] = values(&sample.plan);
        let lost = if *count > 4 { vec![4] } else { Vec::new() };
        for &member in &lost {
            members[member].fill(f64::NAN);
        }
        let drive = sample.rows(*scheme);
        let drive = sample.drive(&drive, *scheme);
        let options = sample.options(*scheme);
        let done = ensemble(&sample.plan, &members.concat(), &drive, &options, &Watch::default()).unwrap();
        let failed: Vec<usize> = done.failures.iter().map(|(member, _)| *member).collect();
        assert_eq!(failed, lost, "{}", sample.name);
        let (mut answers, mut rest) = (Hash::new(), Hash::new());
        answers.numbers(&done.records);
        answers.numbers(&done.closure);
        for &member in &failed {
            rest.count(member);
        }
        Row(format!("{}, {scheme:?}, ensemble", sample.name), [answers.0, rest.0])
    });
    rows.collect()
}

/// Slopes of a sample: forward with the run, forward beside it, and in reverse.
fn slopes_of(sample: &Sample, scheme: Scheme) -> Vec<Row> {
    let name = format!("{}, {scheme:?}", sample.name);
    let options = sample.options(scheme);
    let mut rows = vec![hashed(&format!("{name}, 1 slope"), &sample.run(&sample.sloped::<1>(), &options))];
    if sample.small() {
        rows.push(hashed(&format!("{name}, 8 slopes"), &sample.run(&sample.sloped::<8>(), &options)));
    }
    let (numbers, watch) = (values(&sample.plan), Watch::default());
    let drive = sample.rows(scheme);
    let drive = sample.drive(&drive, scheme);

    // Two groups of eight; the second is not full.
    let done = jacobian(&sample.plan, &numbers, &sample.spread(11), &drive, &options, &watch).unwrap();
    let mut answers = Hash::new();
    answers.numbers(&done.records);
    answers.numbers(&done.slopes);
    rows.push(Row(format!("{name}, jacobian"), [answers.0, 0]));

    // All states are kept, then only some: the steps between these are run again.
    for (kept, bytes) in [("all", 1 << 28), ("some", 1 << 12)] {
        let trajectory = Trajectory::new(&sample.plan, &numbers, &drive, &options, &watch, bytes).unwrap();
        let weights: Vec<f64> =
            (0..trajectory.run.records.len()).map(|i| 1.0 + 0.5 * Real::sin(0.37 * i as f64)).collect();
        let slopes = trajectory.pull(&sample.plan, &numbers, &drive, &options, &watch, &weights).unwrap();
        let name = format!("{name}, gradient, {kept} kept");
        let Row(_, [answers, rest]) = hashed(&name, &trajectory.run);
        let mut all = Hash(answers);
        all.numbers(&slopes);
        rows.push(Row(name, [all.0, rest]));
    }
    rows
}

/// Slopes of all kinds, and matrices.
fn slopes() -> Vec<Row> {
    let [by_area, _, by_geometry] = Sample::glazed();
    let [_, track, switch, scale] = Sample::melting();
    let [measured, .., windows] = Sample::assorted();
    let mut all = vec![
        (Sample::cell(), Scheme::Sdirk2),
        (Sample::cell(), Scheme::ApparentCapacity),
        (Sample::linear_laws(), Scheme::BackwardEuler),
        (Sample::conditioned(), Scheme::Sdirk2),
        (Sample::conditioned(), Scheme::BackwardEuler),
        (by_area, Scheme::Sdirk2),
        (by_geometry, Scheme::BackwardEuler),
        (track, Scheme::BackwardEuler),
        (switch, Scheme::Sdirk2),
        (scale, Scheme::Sdirk2),
        (measured, Scheme::Sdirk2),
        (windows, Scheme::Sdirk2),
    ];
    for (sample, _) in &mut all {
        sample.steps = 16;
    }
    let hard = hard().into_iter().filter(|(sample, _, fails)| sample.small() || *fails == Fails::Nested);
    all.extend(hard.map(|(sample, scheme, _)| (sample, scheme)));
    let mut rows: Vec<Row> =
        all.par_iter().flat_map_iter(|(sample, scheme)| slopes_of(sample, *scheme)).collect();
    let linear = Sample::linear();
    let matrices = state_space(&linear.plan, &values(&linear.plan)).unwrap();
    let (mut answers, mut rest) = (Hash::new(), Hash::new());
    for matrix in [&matrices.a, &matrices.b, &matrices.c, &matrices.d] {
        answers.numbers(matrix);
    }
    for names in [&matrices.states, &matrices.inputs, &matrices.outputs] {
        rest.count(names.len());
        for name in names {
            rest.bytes(name.as_bytes());
        }
    }
    rows.push(Row("linear cell, matrices".to_owned(), [answers.0, rest.0]));
    rows
}

// ---------------------------------------------------------------- tests

/// Makes rows on threads with more stack than they have by default: code that is not optimised needs it.
fn made(rows: impl FnOnce() -> Vec<Row> + Send) -> Vec<Row> {
    rayon::ThreadPoolBuilder::new().stack_size(1 << 25).build().unwrap().install(rows)
}

/// Compares rows with a table; where one differs, prints the table as it would be now.
fn compare(name: &str, table: &[(&str, [u64; 2])], rows: &[Row]) {
    let same = |row: &Row| table.contains(&(row.0.as_str(), row.1));
    let differing: Vec<&str> = rows.iter().filter(|row| !same(row)).map(|row| row.0.as_str()).collect();
    let missing = table.iter().filter(|(name, _)| rows.iter().all(|row| row.0 != *name)).count();
    if differing.is_empty() && missing == 0 {
        return;
    }
    let mut text = String::new();
    for Row(name, [answers, rest]) in rows {
        writeln!(text, "    (\"{name}\", [0x{answers:016x}, 0x{rest:016x}]),").unwrap();
    }
    panic!(
        "{} of {} rows differ from {name} and {missing} of it are missing: {}\n{name} as it would be now:\n{text}",
        differing.len(),
        rows.len(),
        differing.join("; ")
    );
}

/// All runs have the bits that they had when the table was written.
#[test]
fn runs_keep_their_bits() {
    let rows = made(|| {
        let groups: [fn() -> Vec<Row>; 3] = [slopes, lanes, plain];
        groups.into_par_iter().flat_map_iter(|group| group()).collect()
    });
    compare("RUNS", RUNS, &rows);
}

/// Ensembles have these bits with the lanes that the environment asks for, or the widest.
#[test]
fn ensembles_keep_their_bits() {
    compare("ENSEMBLES", ENSEMBLES, &made(ensembles));
}

/// Ensembles have the same bits with narrower lanes: this program runs once more with each, by the variable that asks for
/// them. Where the machine has no wider ones these are those of the test before.
#[test]
fn narrower_lanes_keep_the_bits_of_ensembles() {
    for lanes in ["array", "avx2"] {
        let done = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "golden::ensembles_keep_their_bits"])
            .env(Level::VARIABLE, lanes)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stdout);
        assert!(done.status.success() && said.contains("1 passed"), "lanes of {lanes}:\n{said}");
    }
}
