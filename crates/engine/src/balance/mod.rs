//! Heat balances and the energy ledger.

pub mod flow_index;
pub mod ledger;
pub(crate) mod terms;
pub mod vapour;
