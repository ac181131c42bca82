//! The vapour balances of the zones. Heat does not depend on vapour: they are solved when a step is accepted, with the flows and
//! temperatures of its stages.
//!
//! For the humidity ratio `w` of a zone with the dry air `M`, and the moisture content `u` of the layers behind surfaces:
//!
//! ```text
//! M dw/dt = sum m (w_o - w) + sum m_z (w_z - w) + G - D - sum A f                       [kg/s]
//! f = b (p(w) - phi_1 p_sat(T_s))                                                       [kg/(m2 s)]
//! du_1/dt = f - k p_sat(T_s) (phi_1 - phi_2),    du_2/dt = k p_sat(T_s) (phi_1 - phi_2)
//! ```
//!
//! with outdoor air and air from other zones, sources `G` and what plants and saturation take away, `D`. `p(w)` and `phi(u)` are
//! replaced by their tangents, which are drawn anew until the solution lies on the curves (Newton's method): each solution is linear, and what
//! is stored is what has flowed in. The layers are eliminated onto the zone; the zones are a sparse M-matrix.
//!
//! Each stage alone is a step of backward Euler: its humidity is a mean of what it starts from and of what drives it. The second stage of SDIRK2
//! starts from an extrapolation, and may end beyond both; `bounds` keeps it between them.

mod active_set;
pub(crate) mod balances;
mod bounds;
mod counting;
mod flows;
pub(crate) mod of_step;
mod plants;
mod saturation;
mod surfaces;
