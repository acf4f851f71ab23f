from .bench import Command, new_bench

__all__ = ["Command", "new_bench"]
