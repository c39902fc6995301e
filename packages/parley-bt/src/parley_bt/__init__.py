"""UMRF graphs as BehaviorTree.CPP 4 trees and back, as far as both can say the same (`README.md`)."""

from __future__ import annotations

from parley_bt.read import import_tree
from parley_bt.reasons import EXPORT_REASONS, IMPORT_REASONS
from parley_bt.write import export_tree

__all__ = ["EXPORT_REASONS", "IMPORT_REASONS", "export_tree", "import_tree"]
