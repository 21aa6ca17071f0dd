#pragma once

#include <Eigen/Core>
#include <Eigen/StdVector>
#include <vector>

namespace evo::odometry {

/// A symmetric positive definite matrix of 6x6 blocks, each row stored from its first non-zero block to the diagonal
/// (skyline or envelope storage; A. George, J. W. Liu: Computer Solution of Large Sparse Positive Definite Systems,
/// 1981). Poses in order of time give a narrow skyline, because a track connects only the frames of its lifetime, and
/// the Cholesky factor has the same skyline.
class BlockSkylineMatrix {
 public:
  using Block = Eigen::Matrix<double, 6, 6>;
  using Vector = Eigen::VectorXd;

  /// `first_columns[i]` <= i is the first block column of row i.
  explicit BlockSkylineMatrix(std::vector<int> first_columns);

  int rows() const { return static_cast<int>(first_columns_.size()); }
  void SetZero();
  /// Block (i, j) of the lower triangle, first_columns[i] <= j <= i.
  Block& block(int i, int j) { return blocks_[Index(i, j)]; }
  const Block& block(int i, int j) const { return blocks_[Index(i, j)]; }

  /// Replaces the matrix by its Cholesky factor L; false if it is not positive definite.
  bool Factorize();
  /// Solves L L^T x = b after Factorize().
  Vector Solve(const Vector& b) const;

  /// Number of 6x6 block products in Factorize() with this skyline.
  static double CountBlockProducts(const std::vector<int>& first_columns);

 private:
  std::size_t Index(int i, int j) const { return row_starts_[i] + static_cast<std::size_t>(j - first_columns_[i]); }

  std::vector<int> first_columns_;
  std::vector<std::size_t> row_starts_;  // index of each row's first block
  std::vector<Block, Eigen::aligned_allocator<Block>> blocks_;
};

}  // namespace evo::odometry
