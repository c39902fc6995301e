"""UMRF graphs as BehaviorTree.CPP 4 trees and back, as far as both can say the same (``docs/graphs.md``)."""

from __future__ import annotations

from parley.umrf.bt.read import import_tree
from parley.umrf.bt.reasons import EXPORT_REASONS, IMPORT_REASONS
from parley.umrf.bt.write import export_tree

__all__ = ["EXPORT_REASONS", "IMPORT_REASONS", "export_tree", "import_tree"]
