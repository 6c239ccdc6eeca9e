"""Quadrature of the core's own mass along each segment.

Lobatto's rule with four points (Abramowitz and Stegun 1964, 25.4.32). Two of them are the segment's ends,
nodes that carry mass anyway, so only two points are left that do not; Gauss's rule of the same degree, five,
needs three. As a straight segment bends, the point that is the part s of the way along moves by the second
power of s: the work of its weight and its kinetic energy, of the fourth, come out exactly.
"""

from math import sqrt

AT_END = 1 / 12
"""Mass on either end of a segment, over the segment's."""
AT_POINT = 5 / 12
"""Mass on each of the points between, over the segment's."""
FRACTIONS = ((1 - 1 / sqrt(5)) / 2, (1 + 1 / sqrt(5)) / 2)
"""Distances of these points along the segment, over its length."""
