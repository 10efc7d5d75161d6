"""The shipped decks, for tests that go through all of them; as a program it prints them, one a line."""
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Their start alone takes longer than a test may: terrain, pores around roots, most of a million particles.
LARGE = {"decks/paper/debris_flow.yaml", "decks/paper/wave_mangrove.yaml", "decks/paper/submerged_crater.yaml"}


def affordable():
    """Paths of all decks but the large ones, relative to the project."""
    found = sorted(p.relative_to(ROOT).as_posix() for p in (ROOT / "decks").rglob("*.yaml"))
    return [deck for deck in found if deck not in LARGE]


if __name__ == "__main__":
    print("\n".join(affordable()))
