#pragma once

namespace bandsaw {

/// Combines several lambdas into one visitor of a variant.
template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

}  // namespace bandsaw
