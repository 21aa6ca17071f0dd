#include "odometry/bundle/block_skyline.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace evo::odometry {

BlockSkyline::BlockSkyline(std::vector<int> first) : first_(std::move(first)) {
  std::size_t size = 0;
  for (int i = 0; i < rows(); ++i) {
    start_.push_back(size);
    size += static_cast<std::size_t>(i - first_[i] + 1);
  }
  blocks_.resize(size, Block::Zero());
}

void BlockSkyline::SetZero() { std::ranges::fill(blocks_, Block::Zero()); }

bool BlockSkyline::Factorize() {
  for (int i = 0; i < rows(); ++i) {
    for (int j = first_[i]; j < i; ++j) {
      Block& block = At(i, j);
      for (int k = std::max(first_[i], first_[j]); k < j; ++k) {
        block.noalias() -= At(i, k).lazyProduct(At(j, k).transpose());
      }
      At(j, j).triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(block);
    }
    Block& diagonal = At(i, i);
    for (int k = first_[i]; k < i; ++k) diagonal.noalias() -= At(i, k).lazyProduct(At(i, k).transpose());
    const Eigen::LLT<Block> factor(diagonal);
    if (factor.info() != Eigen::Success) return false;
    diagonal = factor.matrixL();
  }
  return true;
}

BlockSkyline::Vector BlockSkyline::Solve(const Vector& b) const {
  Vector x = b;
  for (int i = 0; i < rows(); ++i) {
    for (int k = first_[i]; k < i; ++k)
      x.segment<6>(Eigen::Index{6} * i) -= At(i, k) * x.segment<6>(Eigen::Index{6} * k);
    auto part = x.segment<6>(Eigen::Index{6} * i);
    At(i, i).triangularView<Eigen::Lower>().solveInPlace(part);
  }
  for (int i = rows() - 1; i >= 0; --i) {
    auto part = x.segment<6>(Eigen::Index{6} * i);
    At(i, i).triangularView<Eigen::Lower>().transpose().solveInPlace(part);
    for (int k = first_[i]; k < i; ++k)
      x.segment<6>(Eigen::Index{6} * k) -= At(i, k).transpose() * x.segment<6>(Eigen::Index{6} * i);
  }
  return x;
}

double BlockSkyline::Cost(const std::vector<int>& first) {
  double products = 0.0;
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    for (int j = first[i]; j <= i; ++j) products += j - std::max(first[i], first[j]) + 1;
  }
  return products;
}

}  // namespace evo::odometry
