#include "odometry/bundle/block_skyline_matrix.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <vector>

namespace evo::odometry {
namespace {

TEST(BlockSkylineMatrix, SolvesLikeADenseFactorization) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const std::vector<int> first = {0, 0, 1, 0, 3, 3};
  BlockSkylineMatrix sparse(first);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(36, 36);
  for (int i = 0; i < 6; ++i) {
    for (int j = first[i]; j <= i; ++j) {
      BlockSkylineMatrix::Block block = BlockSkylineMatrix::Block::NullaryExpr([&] { return normal(random); });
      if (i == j)
        block = BlockSkylineMatrix::Block(block * block.transpose() + 60.0 * BlockSkylineMatrix::Block::Identity());
      sparse.block(i, j) = block;
      dense.block<6, 6>(6 * i, 6 * j) = block;
      dense.block<6, 6>(6 * j, 6 * i) = block.transpose();
    }
  }
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(36, [&] { return normal(random); });
  ASSERT_TRUE(sparse.Factorize());
  EXPECT_LT((sparse.Solve(b) - dense.ldlt().solve(b)).norm(), 1e-10);
}

TEST(BlockSkylineMatrix, RejectsAnIndefiniteMatrix) {
  BlockSkylineMatrix matrix({0});
  matrix.block(0, 0) = -BlockSkylineMatrix::Block::Identity();
  EXPECT_FALSE(matrix.Factorize());
}

}  // namespace
}  // namespace evo::odometry
