//! Heat balances and the energy ledger.

pub mod energy_balance;
pub mod flow_index;
pub(crate) mod terms;
pub mod vapour;
