//! Diffuse radiation of the sky on a plane: any of the models of [`laws`].

pub(crate) mod laws;
pub(crate) mod model;
pub(crate) mod prelude;

use crate::physics::law_row::LawEntry;
use laws::with_laws;
use model::{DiffuseModel, DiffuseSun, Fractions};

/// A model of a description.
#[derive(Debug, Clone, Copy)]
pub struct DiffuseSky {
    /// Its name.
    pub kind: &'static str,
    /// Parts of the diffuse radiation.
    pub(crate) fractions: fn(&DiffuseSun) -> Fractions,
    /// Cosine of the zenith angle that the sun does not go beyond [-].
    pub(crate) lowest: f64,
}

/// Defines the list of the models, one for each file of `laws`.
macro_rules! models {
    ($(($module:ident, $model:ident, $kind:literal))*) => {
        impl DiffuseSky {
            /// All models, in the order of their kinds.
            pub const ALL: &'static [Self] = &[$(Self {
                kind: $kind,
                fractions: laws::$module::$model::fractions,
                lowest: laws::$module::$model::LOWEST,
            }),*];
        }

        /// All models that a description has by name, in the order of their kinds.
        #[must_use]
        pub fn table() -> Vec<LawEntry> {
            vec![$(LawEntry::new($kind, laws::$module::$model::ROW)),*]
        }
    };
}

with_laws!(models);

impl DiffuseSky {
    /// The model of a kind; none where it is none.
    #[must_use]
    pub fn named(kind: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|model| model.kind == kind)
    }
}
