from dataclasses import dataclass


@dataclass
class Counter:
    word: str
    value: int = 0

    def advance(self) -> None:
        self.value += 1

    def __str__(self) -> str:
        return f"{self.word} {self.value}"
