#include <algorithm>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "base/printable.h"
#include "offline/arguments.h"
#include "offline/offline.h"
#ifdef VWD_WITH_ROS
#include "replay/bag_run.h"
#endif

int main(int argc, char** argv) {
  using namespace virtual_work_dynamics;
  const std::string program = "inverse_dynamics_offline";
  try {
    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    const Arguments arguments = parseArguments(words);
    if (arguments.help) {
      std::cout << helpText();
    } else if (arguments.version) {
      std::cout << program << " " << VWD_VERSION << "\n";
#ifdef VWD_WITH_ROS
    } else if (arguments.toBag()) {
      runToBag(arguments);
#endif
    } else {
      runOffline(arguments);
    }
    if (!std::cout.flush()) throw FileError("standard output: cannot be written");
    return 0;
  } catch (const UsageError& error) {
    std::cerr << program << ": error: " << printable(error.what()) << "\nTry '" << program
              << " --help'.\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << program << ": error: " << printable(error.what()) << "\n";
    return 1;
  }
}
