/* The mean of the local USFD wear rate over a line contact with Carter's slip, for many operating points:
 * by uniform cells and by the closed form. Written for speed, as what wearlaw is compared with.
 *
 * All in SI: normal force [N], creepage [-] > 0, friction coefficient [-], wear rate [kg/m/m^2].
 */

#include <math.h>
#include <stddef.h>

typedef struct {
    double radius;  /* relative radius R [m] */
    double modulus; /* E* [Pa] */
    double width;   /* of the track [m] */
    double m_m;     /* [kg/m/N] */
    double q_s;     /* [kg/m/m^2] */
    double m_c;     /* [kg/m/N] */
    double tr_sc;   /* [N/m^2] */
} parameters;

static const double PI = 3.14159265358979323846;

/* Mean over uniform cells with the fields at their centres. `centres` are (x/a) and `roots` sqrt(1 - (x/a)^2). */
void cells(size_t points, const double *force, const double *creepage, const double *friction, double *rate,
           const parameters *p, size_t count, const double *centres, const double *roots)
{
    for (size_t i = 0; i < points; i++) {
        double load = force[i] / p->width;
        double half_width = sqrt(4.0 * load * p->radius / (PI * p->modulus));
        double max_pressure = 2.0 * load / (PI * half_width);
        double saturation = friction[i] * half_width / p->radius;
        double d = creepage[i] / saturation;
        double stick = fmax(1.0 - d, 0.0); /* c/a */
        double scale = friction[i] * max_pressure * saturation, sum = 0.0;
        for (size_t j = 0; j < count; j++) {
            /* s/(ka) = sqrt((x/a + 1 - c/a)^2 - (c/a)^2), which is d + x/a for full slip. */
            double shifted = stick > 0.0 ? centres[j] + d : 0.0, slip;
            slip = stick > 0.0 ? sqrt(fmax(shifted * shifted - stick * stick, 0.0)) : d + centres[j];
            double w = scale * roots[j] * slip;
            sum += fmin(p->m_m * w, p->q_s) + p->m_c * fmax(w - p->tr_sc, 0.0);
        }
        rate[i] = sum / (double)count;
    }
}

/* The root in (0, top) of v (2 - v) (b + g v)^2 = square, where the left side is largest at top, by Halley's method.
 *
 * The integrals are stationary in the roots, so that 1e-8 of error in a root is below rounding in them. The last
 * step is measured also by the distance to top, near which the two roots of an integral are close. */
static double root(double b, double g, double square, double top, double v)
{
    for (int step = 0; step < 60; step++) {
        double l = b + g * v, parabola = v * (2.0 - v), slope = 2.0 * (1.0 - v);
        double f = parabola * l * l - square;
        double f1 = l * (slope * l + 2.0 * g * parabola);
        double f2 = 2.0 * (g * g * parabola + 2.0 * g * slope * l - l * l);
        double change = -f * f1 / (f1 * f1 - 0.5 * f * f2);
        double next = v + change;
        if (!(next > 0.0)) {
            v = 0.25 * v;
        } else if (!(next < top)) {
            v = 0.5 * (v + top);
        } else {
            v = next;
            if (fabs(change) <= 5e-4 * fmin(v, top - v))
                break;
        }
    }
    return v;
}

/* The integral of max((a + h t) sqrt(1 - t^2) - level, 0) over -1 < t < 1, for 0 < h <= a. */
static double excess(double a, double h, double level)
{
    double peak_at = 2.0 * h / (a + sqrt(a * a + 8.0 * h * h));
    double to_right = 1.0 - peak_at, to_left = 1.0 + peak_at;
    double peak_l = a + h * peak_at;
    double square = level * level, peak_square = peak_l * peak_l * to_right * to_left;
    if (!(peak_square > square))
        return 0.0;
    double chord = sqrt(1.0 - square / peak_square); /* of an ellipse with this peak */
    double right = root(a + h, -h, square, to_right, to_right * (1.0 - chord));
    double left = root(a - h, h, square, to_left, to_left * (1.0 - chord));
    double t1 = left - 1.0, t2 = 1.0 - right;
    double s1 = left * (2.0 - left), s2 = right * (2.0 - right), r1 = sqrt(s1), r2 = sqrt(s2);
    double arcs = asin(t2) - asin(t1);
    return 0.5 * a * (t2 * r2 - t1 * r1 + arcs) - h / 3.0 * (s2 * r2 - s1 * r1) - level * (t2 - t1);
}

/* Mean over the patch in closed form: a sum of ramps in w = C (A + h t) sqrt(1 - t^2), t over the slip zone. */
void closed_form(size_t points, const double *force, const double *creepage, const double *friction, double *rate,
                 const parameters *p)
{
    double mild = p->q_s / p->m_m;
    for (size_t i = 0; i < points; i++) {
        double load = force[i] / p->width;
        double half_width = sqrt(4.0 * load * p->radius / (PI * p->modulus));
        double max_pressure = 2.0 * load / (PI * half_width);
        double saturation = friction[i] * half_width / p->radius;
        double d = creepage[i] / saturation;
        double h = fmin(d, 1.0), a = fmax(2.0 - d, d);
        double c = friction[i] * max_pressure * saturation * h;
        double total = p->m_m * 0.5 * PI * a;
        /* (a + h t) sqrt(1 - t^2) stays below a + h. */
        if (c * (a + h) > mild)
            total -= p->m_m * excess(a, h, mild / c);
        if (c * (a + h) > p->tr_sc)
            total += p->m_c * excess(a, h, p->tr_sc / c);
        rate[i] = 0.5 * h * c * total;
    }
}
