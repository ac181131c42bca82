from .dsc import DscMaterial as DscMaterial
from .dsc import from_dsc as from_dsc
from .dsc_several import from_dsc_files as from_dsc_files
from .library import Curve as Curve
from .library import Product as Product
from .library import product as product
from .library import products as products
from .library import search as search

__all__: list[str]
