"""How the hot path is compiled; nothing here is about people."""

from mesa_mobility.compiled.processor import use_wide_vectors

use_wide_vectors()
