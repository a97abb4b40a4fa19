/* FASTSIM on ellipses (Kalker, Vehicle System Dynamics 11 (1982) 1-13): one patch after the other, its strips side by
 * side. Written for speed, as what the marches of wearlaw are compared with; the same cells, the same outputs.
 *
 * All in SI, one entry a patch. Outputs are of shape (patches, cells, strips): the middle of the cell, the means of the
 * tractions at its ends, its mean slips, and the mean of the bounds at its ends.
 */

#include <math.h>
#include <stddef.h>

void march(size_t patches, size_t cells, size_t strips, int elliptic, const double *a, const double *b,
           const double *creepage_x, const double *creepage_y, const double *spin, const double *flexibility_x,
           const double *flexibility_y, const double *flexibility_spin, const double *bound_centre,
           double *restrict x, double *restrict traction_x, double *restrict traction_y, double *restrict slip_x,
           double *restrict slip_y, double *restrict bound)
{
    /* Tractions and bounds are halved, so that the mean over a cell is a sum. */
    double half_length[strips], grow_x[strips], grow_y[strips], turn[strips], greatest[strips], over_x[strips],
        over_y[strips], half_x[strips], half_y[strips];
    for (size_t p = 0; p < patches; p++) {
        for (size_t j = 0; j < strips; j++) {
            double v = (2.0 * (double)j + 1.0) / (double)strips - 1.0, s = sqrt(1.0 - v * v);
            double length = 2.0 * a[p] * s / (double)cells;
            double half_spin = 0.5 * spin[p] / flexibility_spin[p] * length;
            half_length[j] = a[p] * s;
            grow_x[j] = 0.5 * creepage_x[p] / flexibility_x[p] * length - half_spin * b[p] * v;
            grow_y[j] = 0.5 * creepage_y[p] / flexibility_y[p] * length;
            turn[j] = -half_spin * a[p] * s;
            greatest[j] = 0.5 * bound_centre[p] * (elliptic ? s : s * s);
            over_x[j] = 2.0 * flexibility_x[p] / length;
            over_y[j] = 2.0 * flexibility_y[p] / length;
            half_x[j] = half_y[j] = 0.0;
        }
        double before = 0.0;
        for (size_t k = 0; k < cells; k++) {
            double middle = (2.0 * (double)k + 1.0) / (double)cells - 1.0;
            double end = 4.0 * (double)(k + 1) * (double)(cells - k - 1) / ((double)cells * (double)cells);
            if (elliptic)
                end = sqrt(end);
            double both = before + end;
            size_t first = (p * cells + k) * strips;
            for (size_t j = 0; j < strips; j++) {
                double free_x = half_x[j] + grow_x[j], free_y = half_y[j] + (grow_y[j] + turn[j] * middle);
                double share = greatest[j] * end / sqrt(free_x * free_x + free_y * free_y);
                share = share < 1.0 ? share : 1.0;
                double next_x = free_x * share, next_y = free_y * share;
                x[first + j] = half_length[j] * middle;
                traction_x[first + j] = half_x[j] + next_x;
                traction_y[first + j] = half_y[j] + next_y;
                slip_x[first + j] = (free_x - next_x) * over_x[j];
                slip_y[first + j] = (free_y - next_y) * over_y[j];
                bound[first + j] = greatest[j] * both;
                half_x[j] = next_x;
                half_y[j] = next_y;
            }
            before = end;
        }
    }
}
