"""The passes of one scene, called one by one from Python."""

import numpy as np

from statics.kernels.loading import Family, Loader, load
from statics.scene import Scene


class Passes:
    """A scene's kernel with its tables, and the ``chain`` that passes leave for one another."""

    def __init__(self, scene: Scene, family: Family, loader: Loader = load) -> None:
        self.kernel = loader(scene.structure, family)
        self.segments = scene.table("segment", self.kernel.segment_columns)
        self.disks = scene.table("disk", self.kernel.disk_columns)
        self.shape = scene.arm.segments, len(scene.coordinates)
        self.chain = np.empty((self.shape[0], self.kernel.widths["chain"]))

    def pose(self, q: np.ndarray, inputs: np.ndarray) -> dict[str, float]:
        """Outward, at rest: potential if there is one, and clearance."""
        if "lengths" in self.kernel.signatures:
            self.kernel.run("lengths", q, inputs, self.segments, self.chain)
            self.kernel.run("beyond", self.chain)
        return self.kernel.run("pose", q, inputs, self.segments, self.disks, self.chain)

    def motion(self, q: np.ndarray, u: np.ndarray, w: np.ndarray, inputs: np.ndarray) -> dict[str, float]:
        """Outward, in motion: powers."""
        if "lengths" in self.kernel.signatures:
            self.kernel.run("lengths", q, u, inputs, self.segments, self.chain)
            self.kernel.run("beyond", self.chain)
        return self.kernel.run("motion", q, u, w, inputs, self.segments, self.disks, self.chain)

    def residual(self) -> np.ndarray:
        """Unbalanced generalized forces where the outward pass was run, shape (segments, dofs)."""
        found = np.empty(self.shape)
        self.kernel.run("residual", self.disks, self.chain, found)
        return found

    def solve(self, residual: np.ndarray, **given: float) -> tuple[np.ndarray, dict[str, float]]:
        """What elimination and substitution make of a residual, shape of it, and what is counted."""
        descent, change = np.empty(self.shape), np.empty(self.shape)
        known = {name: given.get(name, 0.0) for name in self.kernel.signatures["eliminate"].given}
        pivots = np.empty((self.shape[0], self.kernel.widths.get("pivots", 0)))
        counted = self.kernel.run(
            "eliminate",
            *(
                self.segments,
                self.disks,
                self.chain,
                residual,
                descent,
                pivots,
            ),
            **known,
        )
        self.kernel.run("substitute", self.chain, descent, change)
        return change, counted
