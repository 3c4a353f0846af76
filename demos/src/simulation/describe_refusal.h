#pragma once
// Adds to an error of the library the part of the scene that it concerns.

#include <stdexcept>
#include <string>

namespace softcell::demos {

/// @param described  the part: "arena.toml:12:1: soft body 3"; empty: no file describes the scene
/// @throws std::runtime_error  `work` threw one, or std::invalid_argument: its message, after the description.
template <class Work>
auto describe_refusal(const std::string& described, Work&& work) {
  const auto sentence = [&](const std::exception& refusal) {
    return described.empty() ? std::string(refusal.what()) : described + ": " + refusal.what();
  };
  try {
    return work();
  } catch (const std::invalid_argument& refusal) {
    throw std::runtime_error(sentence(refusal));
  } catch (const std::runtime_error& refusal) {
    throw std::runtime_error(sentence(refusal));
  }
}

}  // namespace softcell::demos
