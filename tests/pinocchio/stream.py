"""Numbers by name: the same deterministic stream in Python and in Rust, so that no input has to be stored.

A number belongs to a *key*, a text such as "panda/free/17/v/panda_joint3"; its stream is SplitMix64 (Steele, Lea and
Flood 2014) seeded with the 64-bit FNV-1a hash of the key's UTF-8 bytes. Because keys hold names and not indices, no
order of joints or links is shared between the two sides.

  unit     u = (z >> 11) 2⁻⁵³           in [0, 1)
  signed   2u − 1                       in [−1, 1)
  weight   u − 1 if u < ½, else u       in [−1, −½) or [½, 1): a weight that can hide no entry
"""

MASK = (1 << 64) - 1


def fnv1a(key):
    """64-bit FNV-1a hash of a text."""
    h = 0xCBF29CE484222325
    for byte in key.encode():
        h = ((h ^ byte) * 0x100000001B3) & MASK
    return h


class Stream:
    """SplitMix64 of one key."""

    def __init__(self, key):
        self.state = fnv1a(key)

    def next(self):
        """The next 64 bits."""
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return z ^ (z >> 31)

    def unit(self):
        """Uniform in [0, 1)."""
        return (self.next() >> 11) * 2.0**-53

    def signed(self, n):
        """n numbers, uniform in [−1, 1)."""
        return [2.0 * self.unit() - 1.0 for _ in range(n)]

    def weights(self, n):
        """n weights, none of them small."""
        return [u - 1.0 if u < 0.5 else u for u in (self.unit() for _ in range(n))]

    def below(self, n):
        """An index below n."""
        return int(self.unit() * n)

    def pick(self, items):
        """One of the items."""
        return items[self.below(len(items))]
