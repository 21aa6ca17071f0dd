#include "odometry/bundle/block_skyline_matrix.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace evo::odometry {

BlockSkylineMatrix::BlockSkylineMatrix(std::vector<int> first_columns) : first_columns_(std::move(first_columns)) {
  std::size_t size = 0;
  for (int i = 0; i < rows(); ++i) {
    row_starts_.push_back(size);
    size += static_cast<std::size_t>(i - first_columns_[i] + 1);
  }
  blocks_.resize(size, Block::Zero());
}

void BlockSkylineMatrix::SetZero() { std::ranges::fill(blocks_, Block::Zero()); }

bool BlockSkylineMatrix::Factorize() {
  for (int i = 0; i < rows(); ++i) {
    for (int j = first_columns_[i]; j < i; ++j) {
      Block& entry = block(i, j);
      for (int k = std::max(first_columns_[i], first_columns_[j]); k < j; ++k) {
        entry.noalias() -= block(i, k).lazyProduct(block(j, k).transpose());
      }
      block(j, j).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(entry);
    }
    Block& diagonal = block(i, i);
    for (int k = first_columns_[i]; k < i; ++k) diagonal.noalias() -= block(i, k).lazyProduct(block(i, k).transpose());
    const Eigen::LLT<Block> factor(diagonal);
    if (factor.info() != Eigen::Success) return false;
    diagonal = factor.matrixL();
  }
  return true;
}

BlockSkylineMatrix::Vector BlockSkylineMatrix::Solve(const Vector& b) const {
  Vector x = b;
  for (int i = 0; i < rows(); ++i) {
    for (int k = first_columns_[i]; k < i; ++k)
      x.segment<6>(Eigen::Index{6} * i) -= block(i, k) * x.segment<6>(Eigen::Index{6} * k);
    auto part = x.segment<6>(Eigen::Index{6} * i);
    block(i, i).triangularView<Eigen::Lower>().solveInPlace(part);
  }
  for (int i = rows() - 1; i >= 0; --i) {
    auto part = x.segment<6>(Eigen::Index{6} * i);
    block(i, i).triangularView<Eigen::Lower>().transpose().solveInPlace(part);
    for (int k = first_columns_[i]; k < i; ++k)
      x.segment<6>(Eigen::Index{6} * k) -= block(i, k).transpose() * x.segment<6>(Eigen::Index{6} * i);
  }
  return x;
}

double BlockSkylineMatrix::CountBlockProducts(const std::vector<int>& first_columns) {
  double products = 0.0;
  for (int i = 0; i < static_cast<int>(first_columns.size()); ++i) {
    for (int j = first_columns[i]; j <= i; ++j) products += j - std::max(first_columns[i], first_columns[j]) + 1;
  }
  return products;
}

}  // namespace evo::odometry
