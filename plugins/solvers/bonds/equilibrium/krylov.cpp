// Conjugate gradients and GMRES on free degrees of freedom, preconditioned by an inverse.
#include "equilibrium/linear_solver.h"

#include <Eigen/Dense>

namespace bonds {

namespace {

void multiply(const sdk::Call &call, const BlockMatrix &matrix, const Vector &free, const Vector &x,
              Vector &y)
{
   matrix.multiply(call, x, y);
   y.array() *= free.array();
}

} // namespace

Solution conjugateGradients(const sdk::Call &call, const BlockMatrix &matrix, const Vector &free,
                            const Inverse &inverse, const Vector &r0, double tolerance, int most, Vector &x)
{
   Solution out;
   Vector r = r0.cwiseProduct(free), z, p, q;
   x.setZero(r.size());
   const double start = r.norm();
   inverse.apply(call, r, z);
   p = z;
   double rz = r.dot(z);
   while (start > 0 && out.iterations < most && !call.cancelled()) {
      multiply(call, matrix, free, p, q);
      const double curvature = p.dot(q);
      if (!(curvature > 0)) {
         out.indefinite = true;
         if (out.iterations == 0)
            x = p;
         break;
      }
      ++out.iterations;
      const double step = rz / curvature;
      x += step * p;
      r -= step * q;
      out.residual = r.norm() / start;
      if (!(out.residual > tolerance))
         break;
      inverse.apply(call, r, z);
      const double next = r.dot(z);
      p = z + (next / rz) * p;
      rz = next;
   }
   return out;
}

Solution minimalResidual(const sdk::Call &call, const BlockMatrix &matrix, const Vector &free,
                         const Inverse &inverse, const Vector &r0, double tolerance, int most, Vector &x)
{
   Solution out;
   Vector r = r0.cwiseProduct(free), w;
   x.setZero(r.size());
   const double start = r.norm();
   out.residual = start > 0 ? 1 : 0;
   if (!(start > 0))
      return out;
   std::vector<Vector> basis{r / start}, turned;
   Eigen::MatrixXd h = Eigen::MatrixXd::Zero(most + 1, most);
   Eigen::VectorXd y;
   while (out.iterations < most && out.residual > tolerance && !call.cancelled()) {
      const int j = out.iterations++;
      Vector z;
      inverse.apply(call, basis.back(), z);
      multiply(call, matrix, free, z, w);
      turned.push_back(std::move(z));
      for (int pass = 0; pass < 2; ++pass) // once more: Gram and Schmidt alone lose digits
         for (int i = 0; i <= j; ++i) {
            const double part = w.dot(basis[i]);
            h(i, j) += part;
            w -= part * basis[i];
         }
      h(j + 1, j) = w.norm();
      Eigen::VectorXd right = Eigen::VectorXd::Zero(j + 2);
      right[0] = start;
      const auto square = h.topLeftCorner(j + 2, j + 1);
      y = square.colPivHouseholderQr().solve(right);
      out.residual = (right - square * y).norm() / start;
      if (!(h(j + 1, j) > 1e-14)) // A B is near 1
         break;
      basis.push_back(w / h(j + 1, j));
   }
   for (int i = 0; i < out.iterations; ++i)
      x += y[i] * turned[i];
   return out;
}

} // namespace bonds
