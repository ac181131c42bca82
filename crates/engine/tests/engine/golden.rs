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
    ("cell, Sdirk2, 1 slope", [0x33ded90bbc1af851, 0x1b196720af34267b]),
    ("cell, Sdirk2, 8 slopes", [0x615cf6c622e78001, 0x5c11a53efdb81982]),
    ("cell, Sdirk2, jacobian", [0x9a80a343adbf0f0a, 0x0000000000000000]),
    ("cell, Sdirk2, gradient, all kept", [0x0603a0226329d4d8, 0x560a655b4e19eb9c]),
    ("cell, Sdirk2, gradient, some kept", [0x5d5f2ec8ce9dfb6b, 0x560a655b4e19eb9c]),
    ("cell, ApparentCapacity, 1 slope", [0x6cad738ef3882d53, 0x2b96ca45a93b7f51]),
    ("cell, ApparentCapacity, 8 slopes", [0xf21d16def6f53d9b, 0xd8f9aed72e9d32e3]),
    ("cell, ApparentCapacity, jacobian", [0xa334054f59d40f02, 0x0000000000000000]),
    ("cell, ApparentCapacity, gradient, all kept", [0xce18943ffb8a716c, 0xf345846e75563a1b]),
    ("cell, ApparentCapacity, gradient, some kept", [0xb9a3958be655bc92, 0xf345846e75563a1b]),
    ("cell of linear laws, BackwardEuler, 1 slope", [0xd8b6ab6d2aa94d02, 0x7421e84d4b793496]),
    ("cell of linear laws, BackwardEuler, 8 slopes", [0x0c97770553b65c01, 0x327cf23d9aea8b7a]),
    ("cell of linear laws, BackwardEuler, jacobian", [0x22e788629ec0fa62, 0x0000000000000000]),
    ("cell of linear laws, BackwardEuler, gradient, all kept", [0xc2e8206f8a35274e, 0xa997954be191d10a]),
    ("cell of linear laws, BackwardEuler, gradient, some kept", [0x6da5ec7007b314a7, 0xa997954be191d10a]),
    ("conditioned cell, Sdirk2, 1 slope", [0xb0ed1d0fb4b6b571, 0x8e14b578256f6895]),
    ("conditioned cell, Sdirk2, 8 slopes", [0xf1aa5a5654790524, 0x652f7b4dddb339af]),
    ("conditioned cell, Sdirk2, jacobian", [0xc0d43e6215814247, 0x0000000000000000]),
    ("conditioned cell, Sdirk2, gradient, all kept", [0x4783de3f125fa5ec, 0xc7e19af43e112e2e]),
    ("conditioned cell, Sdirk2, gradient, some kept", [0x9dae38451aafa4be, 0xc7e19af43e112e2e]),
    ("conditioned cell, BackwardEuler, 1 slope", [0x0c71f8a587f375df, 0x82a09e3b755a7928]),
    ("conditioned cell, BackwardEuler, 8 slopes", [0x774191d9f06d38a4, 0x9d9057dbae975b70]),
    ("conditioned cell, BackwardEuler, jacobian", [0x344d760777092aae, 0x0000000000000000]),
    ("conditioned cell, BackwardEuler, gradient, all kept", [0xf864f1e4d80bbd7c, 0xad781420bf518624]),
    ("conditioned cell, BackwardEuler, gradient, some kept", [0x5f5af5fa10b5d387, 0xad781420bf518624]),
    ("glazed room, sun by area, Sdirk2, 1 slope", [0xeb4aa6ac9244a3ae, 0x89c22d529377c403]),
    ("glazed room, sun by area, Sdirk2, 8 slopes", [0x59cfdbcfc6f934eb, 0x49b17596ec0b78b4]),
    ("glazed room, sun by area, Sdirk2, jacobian", [0x2aa09f74510218a6, 0x0000000000000000]),
    ("glazed room, sun by area, Sdirk2, gradient, all kept", [0x3ef7c65403aee658, 0x49544e9a1c2bb8c1]),
    ("glazed room, sun by area, Sdirk2, gradient, some kept", [0xed355bd199fde247, 0x49544e9a1c2bb8c1]),
    ("glazed room, sun by geometry, BackwardEuler, 1 slope", [0xf32c5b6843b38090, 0xd7ebaa34eb4a2122]),
    ("glazed room, sun by geometry, BackwardEuler, 8 slopes", [0x0a6f21c6287164f9, 0x976abc5ce507525d]),
    ("glazed room, sun by geometry, BackwardEuler, jacobian", [0x65bee1ae3ba485bd, 0x0000000000000000]),
    ("glazed room, sun by geometry, BackwardEuler, gradient, all kept", [0x53696f9fab22575e, 0xecf84ad4e7d61ebf]),
    ("glazed room, sun by geometry, BackwardEuler, gradient, some kept", [0xef8701fdbd6124e3, 0xecf84ad4e7d61ebf]),
    ("curve track, BackwardEuler, 1 slope", [0xd772508ca16d0b03, 0x07f69bce09259086]),
    ("curve track, BackwardEuler, jacobian", [0xcad8731577565cd6, 0x0000000000000000]),
    ("curve track, BackwardEuler, gradient, all kept", [0x96bf43a7edf578fb, 0x6d12c737bd59754c]),
    ("curve track, BackwardEuler, gradient, some kept", [0x6cc1e2b27c50a0ee, 0x6d12c737bd59754c]),
    ("curve switch, Sdirk2, 1 slope", [0x3b12b4457a75f847, 0x0a9ba4e24778d5af]),
    ("curve switch, Sdirk2, jacobian", [0x3d85c4866d7edca4, 0x0000000000000000]),
    ("curve switch, Sdirk2, gradient, all kept", [0xf5a6a7be19024794, 0x2824b38432d129d7]),
    ("curve switch, Sdirk2, gradient, some kept", [0xcab719cd15fb5e8d, 0x2824b38432d129d7]),
    ("curve scale, Sdirk2, 1 slope", [0x964f399d31bba00c, 0x2edb93aafffd94b6]),
    ("curve scale, Sdirk2, jacobian", [0xb7f931e9933f98c9, 0x0000000000000000]),
    ("curve scale, Sdirk2, gradient, all kept", [0xed74677aa001859d, 0xdf843cf0fcc01c26]),
    ("curve scale, Sdirk2, gradient, some kept", [0x99bce1d86d0fe702, 0xdf843cf0fcc01c26]),
    ("assorted cell, measured sky, Sdirk2, 1 slope", [0x41415e4c93802479, 0x70ad49d68fc4cecb]),
    ("assorted cell, measured sky, Sdirk2, 8 slopes", [0xdd63670b22749c3a, 0x921982d9190c8b00]),
    ("assorted cell, measured sky, Sdirk2, jacobian", [0xa2e988e7e4572b73, 0x0000000000000000]),
    ("assorted cell, measured sky, Sdirk2, gradient, all kept", [0xa75592555dc90d04, 0x37d696f66facc302]),
    ("assorted cell, measured sky, Sdirk2, gradient, some kept", [0x8547d461fd16fa15, 0x37d696f66facc302]),
    ("assorted windows, Sdirk2, 1 slope", [0x4370ddbb637cebc4, 0x3cf72766783c1261]),
    ("assorted windows, Sdirk2, 8 slopes", [0x240252bf10dd10f9, 0x470d416f5d46dbd6]),
    ("assorted windows, Sdirk2, jacobian", [0x2132bac27e58fe2d, 0x0000000000000000]),
    ("assorted windows, Sdirk2, gradient, all kept", [0xe54ecc68e42681e8, 0xf41343c54941916d]),
    ("assorted windows, Sdirk2, gradient, some kept", [0x8dfa12f8c8c8f929, 0xf41343c54941916d]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, 1 slope", [0x4d87eb3d54600b0f, 0x6f46cc982be2c97f]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, 8 slopes", [0x2c9b8f1b477cd004, 0x33fcad67ef5ba56e]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, jacobian", [0xc3dbfbc25184efd1, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, gradient, all kept", [0x8612bc183b968ed5, 0x8dd2193d61fcafa6]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, gradient, some kept", [0xba7e0190b32af4b0, 0x8dd2193d61fcafa6]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, 1 slope", [0x14672523f46f4501, 0xb9373ef51acc7375]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, 8 slopes", [0x7b16b463883e4810, 0x1f64fa049cce2fd2]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, jacobian", [0x05075027de924b58, 0x0000000000000000]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, gradient, all kept", [0xdfbb8bec4db65e21, 0xf638ede0bfa87649]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, gradient, some kept", [0x8adfa9cacad32b92, 0xf638ede0bfa87649]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, 1 slope", [0x7ddb81bbd29b0cd1, 0xf55ccebd05f0d159]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, jacobian", [0x2ab63d70aeb35db6, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, gradient, all kept", [0xd7a44dd4c8edb112, 0x5c09a360556b426a]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, gradient, some kept", [0x08748024bd0489ed, 0x5c09a360556b426a]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, 1 slope", [0xb02b8e6fb2025919, 0xa1e6658113e4f8ed]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, 8 slopes", [0xe66fc0af1c70819f, 0x3d70bd3f8194b3df]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, jacobian", [0x7b002a2368f824d9, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, gradient, all kept", [0xb19d7315a3171943, 0x77198229a4e37e21]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, gradient, some kept", [0xf1e4593756fa21d2, 0x77198229a4e37e21]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, 1 slope", [0x0f44a852f0107c42, 0x8a796f8f4b8cde60]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, jacobian", [0xd58ec49c62f27b2a, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, gradient, all kept", [0x99a6ad3309c56112, 0x77c872a781ca9bb3]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, gradient, some kept", [0x08a2b24c72d62f8e, 0x77c872a781ca9bb3]),
    ("linear cell, matrices", [0x8e8acf1d22451ddf, 0x7ad8fdbd070e8ad0]),
    ("cell, BackwardEuler, 4 lanes", [0xd04bb012e2476262, 0x9d71ea155efc1d34]),
    ("cell, Sdirk2, 8 lanes", [0x6c5ec0904246c24b, 0xca3490b1b8220283]),
    ("cell, ApparentCapacity, 8 lanes", [0x70957eda54388385, 0x9c893e47e3402fa1]),
    ("cell of linear laws, Sdirk2, 4 lanes", [0x2f1308d71ecd4424, 0x915a85566c3ab579]),
    ("cell of linear laws, BackwardEuler, 8 lanes", [0x4e685b077874707a, 0xb4b36d28181f4f89]),
    ("conditioned cell, Sdirk2, 4 lanes", [0x224f65442d436a85, 0x25f1b6540036819a]),
    ("conditioned cell, BackwardEuler, 8 lanes", [0x39622ae94d72604d, 0x666502fc101fdadb]),
    ("glazed room, sun by geometry, Sdirk2, 4 lanes", [0x775cba87645ab998, 0x9ff93a5475040026]),
    ("glazed room, sun by geometry, BackwardEuler, 8 lanes", [0xfa0fa095314640e1, 0x42dc74356993022c]),
    ("curve scale, Sdirk2, 4 lanes", [0x065930f8782dccc5, 0x2d5a967ef613dbe9]),
    ("curve scale, BackwardEuler, 8 lanes", [0xb99bfa7f958d6bba, 0x885335af6ed886d4]),
    ("cell, Sdirk2", [0x88971e282be29f1f, 0x04fb81f8f18eaca2]),
    ("cell, BackwardEuler", [0x1cab02f0e5a5e816, 0x9428b4c23d82d772]),
    ("cell, ApparentCapacity", [0x9e13258e2d89ef74, 0x8371214020894bc1]),
    ("cell of linear laws, Sdirk2", [0xd1c2209cf60648bc, 0x7cf949954c1e4b54]),
    ("cell of linear laws, BackwardEuler", [0x0831713d637ec54f, 0x64b7c67523e5ad71]),
    ("cell of linear laws, ApparentCapacity", [0x1fef07ba1c2c70bb, 0x47e9e83f72e4afff]),
    ("linear cell, Sdirk2", [0xc7dd24357d740877, 0xcb28cc1ceb7d23ba]),
    ("linear cell, BackwardEuler", [0x35336da8f3954138, 0x04d54a1ab75ab264]),
    ("linear cell, ApparentCapacity", [0x35336da8f3954138, 0x04d54a1ab75ab264]),
    ("conditioned cell, Sdirk2", [0x435669f283191d0c, 0x14a321118741d5f0]),
    ("conditioned cell, BackwardEuler", [0xf7b6a1a08c11309c, 0xbb1b8e526f020968]),
    ("conditioned cell, ApparentCapacity", [0x9e18b9de74025a84, 0x8c57be525ad66cde]),
    ("glazed room, sun by area, Sdirk2", [0x421b3daaf5cd41a8, 0xc151e2a4719e65ee]),
    ("glazed room, sun by area, BackwardEuler", [0xe9a4f883e3a3025d, 0xd48348d071b6f7ad]),
    ("glazed room, sun by area, ApparentCapacity", [0xe9a4f883e3a3025d, 0xd48348d071b6f7ad]),
    ("glazed room, sun by shares, Sdirk2", [0xcffe7c7d17fb5b4c, 0xb87ce131dd574786]),
    ("glazed room, sun by shares, BackwardEuler", [0x371012429b01f44f, 0xf3254c15c0b9b96e]),
    ("glazed room, sun by shares, ApparentCapacity", [0x371012429b01f44f, 0xf3254c15c0b9b96e]),
    ("glazed room, sun by geometry, Sdirk2", [0x6c6e5482c4b09061, 0xd8364bb446d85bba]),
    ("glazed room, sun by geometry, BackwardEuler", [0x070e4a908f4b07a1, 0x93a8462074dfb130]),
    ("glazed room, sun by geometry, ApparentCapacity", [0x070e4a908f4b07a1, 0x93a8462074dfb130]),
    ("melting, Sdirk2", [0xb34eb401aa5df16e, 0x665622b8b955eac5]),
    ("melting, BackwardEuler", [0x73791a2c8f88caae, 0x41ad09577dc8cc25]),
    ("melting, ApparentCapacity", [0xf0b977c3b3f8a3a4, 0x41628266ebd7fae1]),
    ("curve track, Sdirk2", [0x88c111fe6b87b3a7, 0x14966a14f24acf1a]),
    ("curve track, BackwardEuler", [0xbaadeb31c1e1ed59, 0xc13a726fe9f43cee]),
    ("curve track, ApparentCapacity", [0x79e805bb63e27b38, 0x1a700fc31a3881ae]),
    ("curve switch, Sdirk2", [0xafddd27e7764d998, 0x33160ed9d8525593]),
    ("curve switch, BackwardEuler", [0xe126c420bf1f5d69, 0xbdfdae56af8daea1]),
    ("curve switch, ApparentCapacity", [0x9fceb1d155bed8c9, 0xd6d3ad51cbb19b9c]),
    ("curve scale, Sdirk2", [0x1041423148adccf2, 0x5e386e0f3ab92588]),
    ("curve scale, BackwardEuler", [0xc4ca4b10d7167892, 0x8d6c1e72bd3e717f]),
    ("curve scale, ApparentCapacity", [0xee39b039508ba2bf, 0x3b739d6454a33700]),
    ("assorted cell, measured sky, Sdirk2", [0x2da4d3e778e34683, 0xbf022085cf7c505c]),
    ("assorted cell, measured sky, BackwardEuler", [0x081b0bcc199fa6e2, 0x73d2a6905a87ce08]),
    ("assorted cell, measured sky, ApparentCapacity", [0x34dd5f383792d100, 0x243fa99ed8f1d1ae]),
    ("assorted cell, Clark and Allen, Sdirk2", [0x11e5ec7f3003f4a6, 0xeccbdec351bb28fd]),
    ("assorted cell, Clark and Allen, BackwardEuler", [0xfae98515933f5afc, 0x48f0d7210e229f8a]),
    ("assorted cell, Clark and Allen, ApparentCapacity", [0xab07fe390ce6dbb8, 0x12fad9035d34bdf3]),
    ("assorted cell, Brunt, Sdirk2", [0x936783b5f10f0684, 0x84fbb40cb6743fb4]),
    ("assorted cell, Brunt, BackwardEuler", [0xc546c57654b90b9d, 0x5faaa6ab8f2b9d2e]),
    ("assorted cell, Brunt, ApparentCapacity", [0x10a908ae08bf8bc8, 0x783ed23f82df7acc]),
    ("assorted cell, offset, Sdirk2", [0x4ffb7ecbcbf382ae, 0x7b21f41e5f17f291]),
    ("assorted cell, offset, BackwardEuler", [0xf4b9cc00062f55b2, 0xf64eaa21527b2704]),
    ("assorted cell, offset, ApparentCapacity", [0xdaa9cd333fd51468, 0xf29cbd229f45fa4b]),
    ("assorted windows, Sdirk2", [0xeeabc9c2d8606387, 0x8f895888689172e4]),
    ("assorted windows, BackwardEuler", [0x4e7e26f2f6a67175, 0xbd054f4b9c36bcd0]),
    ("assorted windows, ApparentCapacity", [0x4e7e26f2f6a67175, 0xbd054f4b9c36bcd0]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler", [0xdbee67494062e69c, 0x8dd2193d61fcafa6]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler", [0xbfeaa81e7123acdd, 0xf638ede0bfa87649]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2", [0x010f5f60a7705b45, 0x5c09a360556b426a]),
    ("ceiling of gamma 100 in 40 nodes, Sdirk2", [0xe97ec5c991a576b7, 0xf50943443863bef2]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler", [0x4eff420e57a04396, 0xe61d5aedfe6aed90]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2", [0xd550948ae8afe3dd, 0xd32a5aed5e373366]),
    ("ceiling of gamma 1000 in 80 nodes with ideal loads, BackwardEuler", [0x2e7786f19309ff3b, 0x28dc99314167e063]),
    ("cell from given temperatures", [0xf0d99957d53d72a0, 0x10ae0e1b4c6b9d73]),
];

#[rustfmt::skip]
const ENSEMBLES: &[(&str, [u64; 2])] = &[
    ("cell, Sdirk2, ensemble", [0xca8d47e3cd7fe638, 0x2cdcdc0dfc5d1141]),
    ("cell of linear laws, Sdirk2, ensemble", [0x021dbcad5f6432a1, 0x2cdcdc0dfc5d1141]),
    ("conditioned cell, Sdirk2, ensemble", [0xbf88173cadb31fe4, 0x2cdcdc0dfc5d1141]),
    ("glazed room, sun by geometry, Sdirk2, ensemble", [0xd7de508c9ca7d246, 0x2cdcdc0dfc5d1141]),
    ("curve scale, Sdirk2, ensemble", [0xc4625e2868179363, 0x2cdcdc0dfc5d1141]),
    ("cell, BackwardEuler, ensemble", [0xd955eae910ba7e01, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, ensemble", [0x65bbe7a3c43a89e0, 0xcbf29ce484222325]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, ensemble", [0x89ecca82728a3d1d, 0xcbf29ce484222325]),
    ("ceiling of gamma 100 in 40 nodes, Sdirk2, ensemble", [0xbd75e4eeca9aaed3, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, ensemble", [0x67fb776f33e117d4, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 80 nodes with ideal loads, BackwardEuler, ensemble", [0x1e55cb91e9c93475, 0xcbf29ce484222325]),
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
        let reached = if fails == Fails::Nested { run.counters.nested } else { run.counters.halvings };
        assert!(reached > 0, "{name}: expected {fails:?}, found {:?}", run.counters);
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
