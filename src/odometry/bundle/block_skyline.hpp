#pragma once

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <vector>

namespace evo::odometry {

/// A symmetric positive definite matrix of 6x6 blocks whose rows begin at their first block that is not zero (a
/// skyline). Poses in order of time give a narrow one, because a track ties together only the frames that it lives
/// through, and Cholesky's factor keeps the shape.
class BlockSkyline {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;
  using Vector = Eigen::VectorXd;

  /// `first[i]` <= i is the first block column of row i.
  explicit BlockSkyline(std::vector<int> first);

  int rows() const { return static_cast<int>(first_.size()); }
  void SetZero();
  /// Block (i, j) of the lower triangle, first[i] <= j <= i.
  Block& At(int i, int j) { return blocks_[start_[i] + static_cast<std::size_t>(j - first_[i])]; }
  const Block& At(int i, int j) const { return blocks_[start_[i] + static_cast<std::size_t>(j - first_[i])]; }

  /// Replaces the matrix by its Cholesky factor L; false if it is not positive definite.
  bool Factorize();
  /// Solves L L^T x = b after Factorize().
  Vector Solve(const Vector& b) const;

  /// Multiplications of 6x6 blocks that Factorize() of such a shape costs.
  static double Cost(const std::vector<int>& first);

 private:
  std::vector<int> first_;
  std::vector<std::size_t> start_;
  std::vector<Block, Eigen::aligned_allocator<Block>> blocks_;
};

}  // namespace evo::odometry
