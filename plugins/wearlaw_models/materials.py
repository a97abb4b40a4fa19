"""The steel of wheels and rails."""

from wearlaw import Material, QuantityLike


def steel(
    *,
    youngs_modulus: QuantityLike = "206.47742 GPa",
    poisson_ratio: float = 0.28,
    density: QuantityLike = "7850 kg/m^3",
    shear_yield_stress: QuantityLike | None = "541.3 MPa",
) -> Material:
    """Return the wheel and rail steel of the twin-disc tests, with any value overridden.

    Parameters
    ----------
    youngs_modulus : Quantity or str
        E [Pa]. Tassini et al. (Wear 268 (2010) 660-667) print neither E nor ν. They print 741.43 kN/m for 1500 MPa on
        discs of 47 mm, which needs E* = 112.0212 GPa. The default E gives this E* with ν = 0.28.
    poisson_ratio : float
        ν [-].
    density : Quantity or str
        ρ [kg/m³].
    shear_yield_stress : Quantity or str, optional
        k [Pa] of the work-hardened surface. The default is an estimate from the hardness 2.625 GPa implied by the KTH
        wear map, yield in tension at Y = H/2.8 (Tabor, The Hardness of Metals, 1951), and k = Y/√3 by von Mises's
        criterion.
    """
    return Material(
        youngs_modulus=youngs_modulus,
        poisson_ratio=poisson_ratio,
        density=density,
        shear_yield_stress=shear_yield_stress,
    )
