//! Hashes of whole runs: a change of the code that keeps every bit keeps all of them.
//!
//! A row of a table has the name of a case and two hashes. The first is of its answers: records, ledger, slopes, matrices,
//! and how often the first period was repeated. The second is of the rest: the state at the end, the counters of the
//! solver and the members that failed. Where answers change on purpose, run the tests and put the tables that they print
//! in the place of the old ones.

use core::fmt::Write as _;
use std::process::Command;

use crate::common::assorted::{assorted_cell, assorted_weather, assorted_windows};
use crate::common::conditioned::{conditioned, conditioned_outputs, conditioned_weather, ideal_load};
use crate::common::glazed::{glazed_outputs, glazed_rooms};
use crate::common::linear::{cell_of_linear_laws, linear_cell};
use crate::common::melting::{ceiling_weather, fine_ceiling, melting, melting_weather};
use crate::common::{
    SCHEMES, cell, cell_members, cell_outputs, cell_weather, forcing, options, values, weather,
};
use mascarin_engine::RunControl;
use mascarin_engine::Scheme;
use mascarin_engine::derivatives::Trajectory;
use mascarin_engine::derivatives::jacobian;
use mascarin_engine::description::Description;
use mascarin_engine::energy_balance::Flow;
use mascarin_engine::forcing::Forcing;
use mascarin_engine::linear_model::state_space;
use mascarin_engine::number::simd::Level;
use mascarin_engine::number::{Dual, Lanes, Mask, Real};
use mascarin_engine::plan::Plan;
use mascarin_engine::run::ensemble::ensemble;
use mascarin_engine::run::outputs::Output;
use mascarin_engine::run::{Options, Run, Warmup, simulate};
use mascarin_engine::state::Initial;
use rayon::prelude::*;

#[rustfmt::skip]
const RUNS: &[(&str, [u64; 2])] = &[
    ("cell, Sdirk2, 1 slope", [0x9d7b75968bf94d3b, 0x515cff511a0318ed]),
    ("cell, Sdirk2, 8 slopes", [0xf5137797dfe583cc, 0xa37c92be79c2b8c6]),
    ("cell, Sdirk2, jacobian", [0x1da3d7a35d2149c9, 0x0000000000000000]),
    ("cell, Sdirk2, gradient, all kept", [0x6fd2e2e2e793be94, 0x4eb7e07c7c13bac7]),
    ("cell, Sdirk2, gradient, some kept", [0x6fd2e2e2e793be94, 0x4eb7e07c7c13bac7]),
    ("cell, ApparentCapacity, 1 slope", [0x30c4f7a2ab86257f, 0x96a1da901b2370ee]),
    ("cell, ApparentCapacity, 8 slopes", [0x814775798655f9c9, 0x0923441f99535c48]),
    ("cell, ApparentCapacity, jacobian", [0x69fc3ac5fccbffbb, 0x0000000000000000]),
    ("cell, ApparentCapacity, gradient, all kept", [0x723e66657515f1b4, 0x7cefaff84e5baacf]),
    ("cell, ApparentCapacity, gradient, some kept", [0x723e66657515f1b4, 0x7cefaff84e5baacf]),
    ("cell of linear laws, BackwardEuler, 1 slope", [0xddacf770d62f6491, 0x1c3d00c14f4c145f]),
    ("cell of linear laws, BackwardEuler, 8 slopes", [0x6787965ff907ded6, 0xb5b8829b8dd8afa2]),
    ("cell of linear laws, BackwardEuler, jacobian", [0xb4e0daa5964479d0, 0x0000000000000000]),
    ("cell of linear laws, BackwardEuler, gradient, all kept", [0xc07bd4640af7d9b3, 0x926c1a83cfd5d24d]),
    ("cell of linear laws, BackwardEuler, gradient, some kept", [0xc07bd4640af7d9b3, 0x926c1a83cfd5d24d]),
    ("conditioned cell, Sdirk2, 1 slope", [0xf6ec4a7d20825fbf, 0xd2792eac6bd6cd0d]),
    ("conditioned cell, Sdirk2, 8 slopes", [0x732b08b2ba13dda3, 0x5855129b8be0fb5a]),
    ("conditioned cell, Sdirk2, jacobian", [0x974e6dfb18a68cee, 0x0000000000000000]),
    ("conditioned cell, Sdirk2, gradient, all kept", [0xc703b9d8c2305c30, 0x1bdeee8672ef647c]),
    ("conditioned cell, Sdirk2, gradient, some kept", [0xc703b9d8c2305c30, 0x1bdeee8672ef647c]),
    ("conditioned cell, BackwardEuler, 1 slope", [0xcabef5d287c8cfff, 0xa47ed8670913a7fd]),
    ("conditioned cell, BackwardEuler, 8 slopes", [0x44510b3325947348, 0x9b8770d2a6d8267c]),
    ("conditioned cell, BackwardEuler, jacobian", [0xc63d023bd8e9d6ee, 0x0000000000000000]),
    ("conditioned cell, BackwardEuler, gradient, all kept", [0xa7cfefd5c7c6d131, 0xd230b6d601029ae7]),
    ("conditioned cell, BackwardEuler, gradient, some kept", [0xa7cfefd5c7c6d131, 0xd230b6d601029ae7]),
    ("glazed room, sun by area, Sdirk2, 1 slope", [0x256a721ec216ac99, 0xcee0ab203de4fa25]),
    ("glazed room, sun by area, Sdirk2, 8 slopes", [0x40eea01e29746af6, 0x3e2991e944b8d80c]),
    ("glazed room, sun by area, Sdirk2, jacobian", [0x06e83875de246496, 0x0000000000000000]),
    ("glazed room, sun by area, Sdirk2, gradient, all kept", [0x904ce3de66ad0e43, 0xbe7743b52c36445f]),
    ("glazed room, sun by area, Sdirk2, gradient, some kept", [0x904ce3de66ad0e43, 0xbe7743b52c36445f]),
    ("glazed room, sun by geometry, BackwardEuler, 1 slope", [0x896c45c8d2c80fe9, 0xee3628f382bc4d39]),
    ("glazed room, sun by geometry, BackwardEuler, 8 slopes", [0x0a55eedcdf59cd07, 0xe4c2c76768c1e580]),
    ("glazed room, sun by geometry, BackwardEuler, jacobian", [0x8fffecca3b4c7b0f, 0x0000000000000000]),
    ("glazed room, sun by geometry, BackwardEuler, gradient, all kept", [0x6826f0135f207dfd, 0x933accd3bab2b9ad]),
    ("glazed room, sun by geometry, BackwardEuler, gradient, some kept", [0x6826f0135f207dfd, 0x933accd3bab2b9ad]),
    ("curve track, BackwardEuler, 1 slope", [0x0f8f96876debf1d1, 0x202c438cfa052e63]),
    ("curve track, BackwardEuler, jacobian", [0x3039bf7b66509cdc, 0x0000000000000000]),
    ("curve track, BackwardEuler, gradient, all kept", [0xbb721f9bec11587f, 0xceba4b94474df6b3]),
    ("curve track, BackwardEuler, gradient, some kept", [0xbb721f9bec11587f, 0xceba4b94474df6b3]),
    ("curve switch, Sdirk2, 1 slope", [0x87f85b19b57e858c, 0x27f7ef5f39812722]),
    ("curve switch, Sdirk2, jacobian", [0x69f271f55efa0c5b, 0x0000000000000000]),
    ("curve switch, Sdirk2, gradient, all kept", [0xc42050fe088928ed, 0xaad6e3dfa2dcac22]),
    ("curve switch, Sdirk2, gradient, some kept", [0xc42050fe088928ed, 0xaad6e3dfa2dcac22]),
    ("curve scale, Sdirk2, 1 slope", [0x4dfc52b47cd416d9, 0xcfdc93b6a3c8deac]),
    ("curve scale, Sdirk2, jacobian", [0x2f4773fc520c2938, 0x0000000000000000]),
    ("curve scale, Sdirk2, gradient, all kept", [0xda81ae8940fc02d4, 0xe34e26978c9fb603]),
    ("curve scale, Sdirk2, gradient, some kept", [0xda81ae8940fc02d4, 0xe34e26978c9fb603]),
    ("assorted cell, measured sky, Sdirk2, 1 slope", [0x36c40a47ebe76eec, 0xcbf7e6396e655bf0]),
    ("assorted cell, measured sky, Sdirk2, 8 slopes", [0x553ca6e3354c0600, 0x3be19f413e15aa93]),
    ("assorted cell, measured sky, Sdirk2, jacobian", [0xc2c6e0cabc9ded52, 0x0000000000000000]),
    ("assorted cell, measured sky, Sdirk2, gradient, all kept", [0x74d6494c25aa7d01, 0x9751cb891e4eef3e]),
    ("assorted cell, measured sky, Sdirk2, gradient, some kept", [0x74d6494c25aa7d01, 0x9751cb891e4eef3e]),
    ("assorted windows, Sdirk2, 1 slope", [0xae04fad0ce374484, 0x5490c208fe78278d]),
    ("assorted windows, Sdirk2, 8 slopes", [0x5e3da9bacea4566e, 0xd19431f7f39a988f]),
    ("assorted windows, Sdirk2, jacobian", [0x2ecd0789611bb160, 0x0000000000000000]),
    ("assorted windows, Sdirk2, gradient, all kept", [0xd2334bcccf6e0903, 0x7e6c6ac39c8a24a5]),
    ("assorted windows, Sdirk2, gradient, some kept", [0xd2334bcccf6e0903, 0x7e6c6ac39c8a24a5]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, 1 slope", [0x3b44980450e20250, 0x1f1c51c7d3ded337]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, 8 slopes", [0x3e43f63b71aaa4b8, 0x3985132cb76bd623]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, jacobian", [0xd96088366e5b90e4, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, gradient, all kept", [0x6920b88b910a0525, 0xbbf40e8987f6e662]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, gradient, some kept", [0x6920b88b910a0525, 0xbbf40e8987f6e662]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, 1 slope", [0x1568aa6aea14b553, 0x4d31daac2a1eaa87]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, 8 slopes", [0xb65e3071c299345b, 0x8c080a00f90ef16a]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, jacobian", [0xbccfb6960b334f56, 0x0000000000000000]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, gradient, all kept", [0x2ba4fa388dba0759, 0xfe7f58a4d0acdc74]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, gradient, some kept", [0x2ba4fa388dba0759, 0xfe7f58a4d0acdc74]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, 1 slope", [0x628d5c487bc1d442, 0x9cf1ac3a4de12f0d]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, jacobian", [0xf8ae7e32a6ea16f6, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, gradient, all kept", [0x53fe7af9b1be0fa0, 0xb6b5a4d7e4133ec4]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2, gradient, some kept", [0x53fe7af9b1be0fa0, 0xb6b5a4d7e4133ec4]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, 1 slope", [0xc73f281e1adc8520, 0x8f5a7260d008acf7]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, 8 slopes", [0x654b52551becd3c8, 0x28748e4c046afa1d]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, jacobian", [0xfb57ff4baf15b155, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, gradient, all kept", [0x84a3071c08ca51d1, 0xf3716ad1a06cf514]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, gradient, some kept", [0x84a3071c08ca51d1, 0xf3716ad1a06cf514]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, 1 slope", [0x616e6e7457c9d3a5, 0xc48304ad448daef6]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, jacobian", [0x3312881948c8fa52, 0x0000000000000000]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, gradient, all kept", [0xe1855faf44443dd5, 0x27e05b6eddb4cb6e]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2, gradient, some kept", [0xe1855faf44443dd5, 0x27e05b6eddb4cb6e]),
    ("linear cell, matrices", [0x8e8acf1d22451ddf, 0x7ad8fdbd070e8ad0]),
    ("cell, BackwardEuler, 4 lanes", [0xad185b1a279616eb, 0x6c9aad97f79bb963]),
    ("cell, Sdirk2, 8 lanes", [0xdb1e3a4e635f74ba, 0x601eb52b95223e79]),
    ("cell, ApparentCapacity, 8 lanes", [0xaabf5cd14ba82431, 0x5ea0852c00c3fd4c]),
    ("cell of linear laws, Sdirk2, 4 lanes", [0x1d75e1444523c98a, 0x22e854be186da9d3]),
    ("cell of linear laws, BackwardEuler, 8 lanes", [0xb141ffacec19998d, 0x8803fbabc55651ab]),
    ("conditioned cell, Sdirk2, 4 lanes", [0x3a3ffbade1e9eeb1, 0xb6df2cb55ce7bed3]),
    ("conditioned cell, BackwardEuler, 8 lanes", [0xdf35ebc89e5af96b, 0xc457a82539014675]),
    ("glazed room, sun by geometry, Sdirk2, 4 lanes", [0x8523dd3d4ce08bdc, 0xbe63134fb1acb1ff]),
    ("glazed room, sun by geometry, BackwardEuler, 8 lanes", [0xb6d5468edfa9c00b, 0xb88e1bc40b56b59b]),
    ("curve scale, Sdirk2, 4 lanes", [0xc2aa28038e740dbd, 0x3323b2118baa5e68]),
    ("curve scale, BackwardEuler, 8 lanes", [0x9cea2fee05eabdbf, 0x6cf69ac292e58637]),
    ("cell, Sdirk2", [0x0c92ebce4c145aaf, 0xe6a6751b3f1c377e]),
    ("cell, BackwardEuler", [0x7be967d144a9217b, 0x3b4f8e46139cf305]),
    ("cell, ApparentCapacity", [0xfd1a2c03bc56c727, 0xf1d7d47410ecf7bb]),
    ("cell of linear laws, Sdirk2", [0x464171ffdb253a55, 0x3c269da1cf89bce2]),
    ("cell of linear laws, BackwardEuler", [0x434e6be2dcfe5a9e, 0xaf841d45279788e1]),
    ("cell of linear laws, ApparentCapacity", [0x7ed0dfafbb8c3a01, 0xae284b852fc1d057]),
    ("linear cell, Sdirk2", [0x101af413633af2c5, 0xb36e1cb2c02d99bb]),
    ("linear cell, BackwardEuler", [0x08af8df1ec5a6e00, 0x718f475ea5927c47]),
    ("linear cell, ApparentCapacity", [0x08af8df1ec5a6e00, 0x718f475ea5927c47]),
    ("conditioned cell, Sdirk2", [0xa7bc66f48f24061d, 0x769c9d5a439c5b40]),
    ("conditioned cell, BackwardEuler", [0xff98d5cc9440f345, 0x81043f30eb64ea74]),
    ("conditioned cell, ApparentCapacity", [0x645f7c58fbf5e491, 0x4608a590f4dbd2f8]),
    ("glazed room, sun by area, Sdirk2", [0x109bb1c7f24d3b34, 0x23805071b15bfcff]),
    ("glazed room, sun by area, BackwardEuler", [0xaaefa3f95668f676, 0x7d57b1e11f5a2297]),
    ("glazed room, sun by area, ApparentCapacity", [0xaaefa3f95668f676, 0x7d57b1e11f5a2297]),
    ("glazed room, sun by shares, Sdirk2", [0x44d01ccd7bf61943, 0xc81062bfb09c2c5f]),
    ("glazed room, sun by shares, BackwardEuler", [0x7617a98a52c449ca, 0xf3eef37cb7c46aae]),
    ("glazed room, sun by shares, ApparentCapacity", [0x7617a98a52c449ca, 0xf3eef37cb7c46aae]),
    ("glazed room, sun by geometry, Sdirk2", [0x8aca58ec5ba5843c, 0x04cc1e5fd471ff19]),
    ("glazed room, sun by geometry, BackwardEuler", [0x8a2b679aa53ed74f, 0x0a06e8404eca9f28]),
    ("glazed room, sun by geometry, ApparentCapacity", [0x8a2b679aa53ed74f, 0x0a06e8404eca9f28]),
    ("melting, Sdirk2", [0xeb22458c43160017, 0x62be73a5e287e47d]),
    ("melting, BackwardEuler", [0xa94d6599abbb03cc, 0x3a3c9a27ffecb699]),
    ("melting, ApparentCapacity", [0x5837bbc3b67dcde0, 0x57f8efbc08ec5483]),
    ("curve track, Sdirk2", [0xf136d8b4d3863683, 0xa966f4300704f546]),
    ("curve track, BackwardEuler", [0x718939e562f47fc2, 0x6292c476154de7ad]),
    ("curve track, ApparentCapacity", [0xa1626e2216c67294, 0x417d24e5a87e063e]),
    ("curve switch, Sdirk2", [0xa5978416d8f63a52, 0x52193aa3be5903b3]),
    ("curve switch, BackwardEuler", [0x3fe7c50f3561f465, 0xb33458de9f028406]),
    ("curve switch, ApparentCapacity", [0xe5f2527306827bcb, 0x23bfd3cb9684456c]),
    ("curve scale, Sdirk2", [0x7304ff27042e19a3, 0xcc9ee37b1b761f6f]),
    ("curve scale, BackwardEuler", [0xb2693743f0bcff1d, 0x1cd5ffdfebe5f19a]),
    ("curve scale, ApparentCapacity", [0x7de11cbad47c1599, 0xd0b1d8e4e7641876]),
    ("assorted cell, measured sky, Sdirk2", [0x6d7a684aeab7a37d, 0x0a7d5270506073e3]),
    ("assorted cell, measured sky, BackwardEuler", [0x8b9b99160a064c12, 0xd5750e48032003bd]),
    ("assorted cell, measured sky, ApparentCapacity", [0x8278a789f2c10ccb, 0xad9ad80117bae207]),
    ("assorted cell, Clark and Allen, Sdirk2", [0x1094619a00e4ece6, 0xb2985114e1bd4570]),
    ("assorted cell, Clark and Allen, BackwardEuler", [0x6323219073758a7b, 0x03e7156191b49a5c]),
    ("assorted cell, Clark and Allen, ApparentCapacity", [0xeac0fb104e9bfff3, 0x28f0f8afb856b913]),
    ("assorted cell, Brunt, Sdirk2", [0x1bc3698748d4b148, 0xc1aafa8636d2e541]),
    ("assorted cell, Brunt, BackwardEuler", [0xa45287c8798c490b, 0xfdfb75fc762482e3]),
    ("assorted cell, Brunt, ApparentCapacity", [0x0dbc4b7a2a0cb25f, 0xbac8caed36f8f894]),
    ("assorted cell, offset, Sdirk2", [0xa7bc936231f530c2, 0xa3ccbc64845e4f97]),
    ("assorted cell, offset, BackwardEuler", [0x23136a260bd45b11, 0x362094d8b83e6495]),
    ("assorted cell, offset, ApparentCapacity", [0x155662f84a4257bc, 0x1c35add83ebccbf9]),
    ("assorted windows, Sdirk2", [0x50b21ffc51aea424, 0x0196e7cb0d6519b0]),
    ("assorted windows, BackwardEuler", [0xb2047366c29b388f, 0x896f4386599f67b2]),
    ("assorted windows, ApparentCapacity", [0xb2047366c29b388f, 0x896f4386599f67b2]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler", [0xab3736737a04c56d, 0xbbf40e8987f6e662]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler", [0x3d3ab3ae092ed296, 0xfe7f58a4d0acdc74]),
    ("ceiling of gamma 1000 in 40 nodes, Sdirk2", [0xa6936ced4f671316, 0xb6b5a4d7e4133ec4]),
    ("ceiling of gamma 100 in 40 nodes, Sdirk2", [0xde7fa69efe8ed690, 0x2f9f5da1ded0e0dd]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler", [0x6a3c4198601b08ef, 0xd7bc3c2c4f9e404b]),
    ("ceiling of gamma 1000 in 40 nodes with ideal loads, Sdirk2", [0x70b3f232cc11c134, 0x494799c2159106ff]),
    ("ceiling of gamma 1000 in 80 nodes with ideal loads, BackwardEuler", [0x4ca0f83eb10b3293, 0xb5a41566d4b54577]),
    ("cell from given temperatures", [0xb2cca1080c08fe23, 0x00e55b855a5bdfb3]),
];

#[rustfmt::skip]
const ENSEMBLES: &[(&str, [u64; 2])] = &[
    ("cell, Sdirk2, ensemble", [0x58283167ba29c680, 0x2cdcdc0dfc5d1141]),
    ("cell of linear laws, Sdirk2, ensemble", [0xc79707238e740fd2, 0x2cdcdc0dfc5d1141]),
    ("conditioned cell, Sdirk2, ensemble", [0xf8df34e166eb5d2f, 0x2cdcdc0dfc5d1141]),
    ("glazed room, sun by geometry, Sdirk2, ensemble", [0xb6e54adb4ca8c5e1, 0x2cdcdc0dfc5d1141]),
    ("curve scale, Sdirk2, ensemble", [0x7edc5ed78a6d0842, 0x2cdcdc0dfc5d1141]),
    ("cell, BackwardEuler, ensemble", [0xea15f5b143108422, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 10 nodes, BackwardEuler, ensemble", [0xa1bf8dae07a8b969, 0xcbf29ce484222325]),
    ("ceiling of gamma 300 in 20 nodes, BackwardEuler, ensemble", [0x28b263b03dce0392, 0xcbf29ce484222325]),
    ("ceiling of gamma 100 in 40 nodes, Sdirk2, ensemble", [0xb2a2e935e587c9df, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 20 nodes with ideal loads, BackwardEuler, ensemble", [0x955441d0eb3c1d2a, 0xcbf29ce484222325]),
    ("ceiling of gamma 1000 in 80 nodes with ideal loads, BackwardEuler, ensemble", [0xb73df693ab0dc607, 0xcbf29ce484222325]),
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
    // Flows that the cases do not have were added later.
    let (before, since) = run.energy_balance.into.split_at(Flow::Bridges as usize);
    answers.lanes(before, failed);
    assert!(since.iter().all(|flow| (0..S::LANES).all(|lane| flow.lane(lane) == 0.0)));
    answers.lanes(
        &[run.energy_balance.stored, run.energy_balance.total_exchanged, run.energy_balance.imbalance],
        failed,
    );
    answers.count(run.cycles);
    for numbers in
        [&run.state.cells[..], &run.state.enthalpy, &run.state.surfaces, &run.state.air, &run.state.load]
    {
        rest.lanes(numbers, failed);
    }
    for memory in &run.state.memory {
        let [first, second, ..] = memory.model_state;
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
    outputs: Vec<Output>,
    /// Whether the first hours are repeated until their end is their start.
    warm_up: bool,
}

impl Sample {
    /// From the morning to the evening.
    fn new(name: &str, description: Description, weather: fn(f64, &mut [f64]), outputs: Vec<Output>) -> Self {
        let plan = Plan::new(description).unwrap();
        Self { name: name.to_owned(), plan, weather, start: 7.0, steps: 40, outputs, warm_up: false }
    }

    fn cell() -> Self {
        Self { warm_up: true, ..Self::new("cell", cell(0.04), cell_weather, every(cell_outputs())) }
    }

    fn linear_laws() -> Self {
        Self::new("cell of linear laws", cell_of_linear_laws(false), cell_weather, cell_outputs())
    }

    fn linear() -> Self {
        let outputs = [0, 1].map(|zone| Output::AirTemperature { zone }).to_vec();
        Self::new("linear cell", linear_cell(), cell_weather, outputs)
    }

    /// From the night to the afternoon: heating and cooling both run.
    fn conditioned() -> Self {
        let sample =
            Self::new("conditioned cell", conditioned(0.04), conditioned_weather, conditioned_outputs());
        Self { start: 2.0, steps: 56, ..sample }
    }

    /// The room with windows, by each law of where the sun lands.
    fn glazed() -> [Self; 3] {
        let names = ["sun by area", "sun by shares", "sun by geometry"];
        let mut rooms = glazed_rooms().into_iter();
        names.map(|name| {
            Self::new(&format!("glazed room, {name}"), rooms.next().unwrap(), weather, glazed_outputs())
        })
    }

    /// All shapes of melting curves, without hysteresis and with each model of it.
    fn melting() -> [Self; 4] {
        [
            ("melting", None),
            ("curve track", Some("curve_track")),
            ("curve switch", Some("curve_switch")),
            ("curve scale", Some("curve_scale")),
        ]
        .map(|(name, model)| {
            let description = melting(model);
            let mut outputs = vec![Output::AirTemperature { zone: 0 }];
            for surface in 0..description.surfaces.len() {
                outputs.push(Output::LiquidFraction { surface, layer: 0 });
                outputs.push(Output::LayerEnthalpy { surface, layer: 0 });
            }
            Self { start: 0.0, steps: 48, ..Self::new(name, description, melting_weather, outputs) }
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
        let outputs = vec![
            Output::AirTemperature { zone: 0 },
            Output::LiquidFraction { surface: 0, layer: 0 },
            Output::FaceFlux { surface: 0, side: 1 },
            Output::CoolingLoad { zone: 0 },
        ];
        let loads = if ideal_loads { " with ideal loads" } else { "" };
        let name = format!("ceiling of gamma {gamma} in {nodes} nodes{loads}");
        Self { start, steps, ..Self::new(&name, d, ceiling_weather, outputs) }
    }

    fn assorted() -> [Self; 5] {
        let cell = |sky: &str, which| {
            let name = format!("assorted cell, {sky}");
            Self::new(&name, assorted_cell(which), assorted_weather, every(conditioned_outputs()))
        };
        [
            cell("measured sky", 0),
            cell("Clark and Allen", 1),
            cell("Brunt", 2),
            cell("offset", 3),
            Self::new("assorted windows", assorted_windows(), weather, glazed_outputs()),
        ]
    }

    fn options(&self, scheme: Scheme) -> Options {
        let warmup = self.warm_up.then_some(Warmup { steps: 12, tolerance: 0.2, max_cycles: 200 });
        Options { warmup, ..options(scheme, STEP, self.outputs.clone()) }
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
        simulate(&self.plan, numbers, &drive, options, &RunControl::default()).unwrap()
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
fn every(mut outputs: Vec<Output>) -> Vec<Output> {
    outputs.push(Output::LayerTemperature { surface: 4, layer: 0 });
    outputs.push(Output::IncidentSolar { surface: 0 });
    outputs.push(Output::SkyTemperature);
    outputs
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
        let done =
            ensemble(&sample.plan, &members.concat(), &drive, &options, &RunControl::default()).unwrap();
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
    let (numbers, watch) = (values(&sample.plan), RunControl::default());
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
    let matrices = state_space(&linear.plan, &values(&linear.plan), &RunControl::default()).unwrap();
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
