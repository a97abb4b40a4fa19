    @property
    def patch_geometry(self) -> wl.Geometry:  # type: ignore[override]
        """Strips, or ellipses by Hertz's theory."""
        return "ellipse" if self.pressure == "hertz" else "strips"

    @model_validator(mode="after")
    def _fits(self) -> Wheelset:
        if self.wheel.kind != "wheel" or self.rail.kind != "rail":
            raise ValueError(
                f"wheel is the profile of a {self.wheel.kind} and rail that of a {self.rail.kind}; give them the other"
                " way round, or make the profile with the other kind"
            )
        lean = self.rail.apparent_cant
        if abs(lean) > 0.5 * scalar(self.rail_cant) > 0.0:
            raise ValueError(
                f"rail_cant: is {np.degrees(scalar(self.rail_cant)):.3g} deg, but the head of the rail's profile leans by"
                f" {np.degrees(lean):.3g} deg already; leave rail_cant out, or give a profile without cant"
            )
        straight = np.zeros(1)
        roll, found = searched(self._section, straight, straight)
        if np.isnan(found.arc[0, :, 0]).any():
            raise ValueError(
                f"gauge: the wheels do not stand on the rails; wheels {self.flange_back_distance!r} apart between their"
                f" inner faces do not fit rails {self.gauge!r} apart"
            )
        angle = self._table(straight, straight, roll, found).angle[0, :, 0]
        if np.abs(angle).max() > scalar(self.flange_angle):
            raise ValueError(
                f"gauge: in the middle of the track the wheels stand on their flanges, at a contact angle of"
                f" {np.degrees(np.abs(angle).max()):.3g} deg; wheels {self.flange_back_distance!r} apart between their"
                f" inner faces do not fit rails {self.gauge!r} apart"
            )
        return self
