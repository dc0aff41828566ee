#include "ros/node_program.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/network.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "base/printable.h"
#include "ros/private_parameters.h"

namespace virtual_work_dynamics {
namespace {

bool isAddress(const std::string& uri) {
  try {
    std::string host;
    std::uint32_t port = 0;
    return ros::network::splitURI(uri, host, port) && !host.empty() && port != 0;
  } catch (const std::exception&) {  // of a port that is not a number
    return false;
  }
}

// roscpp itself ends with a signal, after several lines, when the address is none.
void checkMasterAddress(int argc, char** argv) {
  const std::string remapping = "__master:=";
  std::string source = "ROS_MASTER_URI", uri;
  const char* const from_environment = std::getenv(source.c_str());
  bool given = from_environment != nullptr;
  if (given) uri = from_environment;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.compare(0, remapping.size(), remapping) != 0) continue;
    source = "__master";
    uri = argument.substr(remapping.size());
    given = true;
  }
  if (!given || isAddress(uri)) return;
  throw ParameterError(source + ": expected an address like http://localhost:11311, got '" + uri +
                       "'");
}

// What ROS left of the arguments.
void refuseArguments(int argc, char** argv) {
  if (argc > 1) throw ParameterError(std::string("unknown argument ") + argv[1]);
}

int fail(const std::string& problem) {
  ROS_FATAL("%s", printable(problem).c_str());
  return 1;
}

int runStarted(int argc, char** argv, const NodeProgram& program) {
  // Lives until after the last line is logged: with the last handle, ROS and its console go.
  const ros::NodeHandle private_node("~");
  try {
    refuseArguments(argc, argv);
    program.run(private_node);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
  return 0;
}

}  // namespace

int runNode(int argc, char** argv, const NodeProgram& program) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      std::fputs(program.usage, stdout);
      return 0;
    }
  }
  try {
    checkMasterAddress(argc, argv);
    ros::init(argc, argv, program.name);
    return runStarted(argc, argv, program);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}

}  // namespace virtual_work_dynamics
