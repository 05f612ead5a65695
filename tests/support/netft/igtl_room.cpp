// The motion capture of a SIMULATED room: a server that speaks OpenIGTLink by the protocol's own
// library (libOpenIGTLink), and shares no code with ours.
//
//   igtl_room MOTION.csv TRANSFORM|TDATA|QTDATA [FAULT[=N]…]     prints "port N", then reads "zero
//   NS"
//
// MOTION.csv: a header, then rows t_s and for each body seven columns (x y z in m, qw qx qy qz). A
// row is sent when the monotonic clock has reached zero + t_s, stamped with t_s * RATE + EPOCH as
// the capture system's own clock would. Faults: damage=N (each N-th message has a wrong checksum),
// close=S (closes after S seconds), hush=S (says nothing more after S seconds), busy (a STATUS
// message "busy" at the start), pictures=N (before each N-th row a picture of 1920 × 1080, as a
// server of video sends to everybody).
#include <igtlImageMessage.h>
#include <igtlQuaternionTrackingDataMessage.h>
#include <igtlServerSocket.h>
#include <igtlStatusMessage.h>
#include <igtlTrackingDataMessage.h>
#include <igtlTransformMessage.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace tractus {
namespace {
constexpr double kEpoch_s = 1000.25;

struct Room {
  std::vector<std::string> bodies;
  std::vector<std::vector<double>> rows;
  std::string type;
  std::map<std::string, double> faults;
  int sent = 0;
};

Room read(const char* path) {
  Room out;
  std::ifstream file(path);
  std::string line, cell;
  std::getline(file, line);
  std::istringstream header(line);
  for (int k = 0; std::getline(header, cell, ','); ++k)
    if (k % 7 == 1) out.bodies.push_back(cell.substr(0, cell.find('.')));
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    out.rows.emplace_back();
    while (std::getline(cells, cell, ',')) out.rows.back().push_back(std::atof(cell.c_str()));
  }
  return out;
}

void matrix_of(const double* v, igtl::Matrix4x4& m) {
  float q[4] = {float(v[4]), float(v[5]), float(v[6]), float(v[3])};
  igtl::QuaternionToMatrix(q, m);
  for (int k = 0; k < 3; ++k) m[k][3] = float(1000.0 * v[k]);
}

bool send(Room& room, igtl::Socket* socket, igtl::MessageBase* message, double stamp_s) {
  auto stamp = igtl::TimeStamp::New();
  stamp->SetTime(stamp_s);
  message->SetTimeStamp(stamp);
  message->Pack();
  const auto* begin = static_cast<const char*>(message->GetPackPointer());
  std::vector<char> bytes(begin, begin + message->GetPackSize());
  const auto damage = room.faults.find("damage");
  if (damage != room.faults.end() && ++room.sent % int(damage->second) == 0) bytes.back() ^= 0x10;
  return socket->Send(bytes.data(), int(bytes.size())) != 0;
}

bool send_row(Room& room, igtl::Socket* socket, const std::vector<double>& row) {
  const double stamp_s = row[0] + kEpoch_s;
  igtl::Matrix4x4 m;
  if (room.type == "TRANSFORM") {
    for (std::size_t b = 0; b < room.bodies.size(); ++b) {
      auto message = igtl::TransformMessage::New();
      message->SetDeviceName(room.bodies[b].c_str());
      matrix_of(&row[1 + 7 * b], m);
      message->SetMatrix(m);
      if (!send(room, socket, message, stamp_s)) return false;
    }
    return true;
  }
  if (room.type == "TDATA") {
    auto message = igtl::TrackingDataMessage::New();
    message->SetDeviceName("SIMULATED");
    for (std::size_t b = 0; b < room.bodies.size(); ++b) {
      auto element = igtl::TrackingDataElement::New();
      element->SetName(room.bodies[b].c_str());
      element->SetType(igtl::TrackingDataElement::TYPE_6D);
      matrix_of(&row[1 + 7 * b], m);
      element->SetMatrix(m);
      message->AddTrackingDataElement(element);
    }
    return send(room, socket, message, stamp_s);
  }
  auto message = igtl::QuaternionTrackingDataMessage::New();
  message->SetDeviceName("SIMULATED");
  for (std::size_t b = 0; b < room.bodies.size(); ++b) {
    const double* v = &row[1 + 7 * b];
    auto element = igtl::QuaternionTrackingDataElement::New();
    element->SetName(room.bodies[b].c_str());
    element->SetType(igtl::QuaternionTrackingDataElement::TYPE_6D);
    element->SetPosition(float(1000 * v[0]), float(1000 * v[1]), float(1000 * v[2]));
    element->SetQuaternion(float(v[4]), float(v[5]), float(v[6]), float(v[3]));
    message->AddQuaternionTrackingDataElement(element);
  }
  return send(room, socket, message, stamp_s);
}

bool send_picture(Room& room, igtl::Socket* socket, double stamp_s) {
  auto message = igtl::ImageMessage::New();
  message->SetDeviceName("Video");
  message->SetDimensions(1920, 1080, 1);
  message->SetScalarTypeToUint8();
  message->AllocateScalars();
  std::memset(message->GetScalarPointer(), 0x42, std::size_t(message->GetImageSize()));
  return send(room, socket, message, stamp_s);
}

void say_busy(Room& room, igtl::Socket* socket) {
  auto status = igtl::StatusMessage::New();
  status->SetDeviceName("SIMULATED");
  status->SetCode(igtl::StatusMessage::STATUS_BUSY);
  status->SetErrorName("Busy");
  status->SetStatusString("calibrating");
  send(room, socket, status, kEpoch_s);
}
}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  if (argc < 3) return 2;
  Room room = read(argv[1]);
  room.type = argv[2];
  for (int k = 3; k < argc; ++k) {
    const std::string fault = argv[k];
    const auto at = fault.find('=');
    room.faults[fault.substr(0, at)] =
        at == std::string::npos ? 1.0 : std::atof(fault.c_str() + at + 1);
  }
  auto server = igtl::ServerSocket::New();
  if (server->CreateServer(0) != 0) return 1;
  std::printf("port %d\n", server->GetServerPort());
  std::fflush(stdout);
  igtl::ClientSocket::Pointer client;
  while (client.IsNull()) client = server->WaitForConnection(1000);
  if (room.faults.contains("busy")) say_busy(room, client);
  std::string word;
  long long zero_ns = 0;
  if (!(std::cin >> word >> zero_ns)) return 1;
  const auto zero = std::chrono::steady_clock::time_point(std::chrono::nanoseconds(zero_ns));
  const auto pictures = room.faults.find("pictures");
  int n = 0;
  for (const auto& row : room.rows) {
    if (room.faults.contains("close") && row[0] > room.faults["close"]) break;
    if (room.faults.contains("hush") && row[0] > room.faults["hush"]) break;
    std::this_thread::sleep_until(zero + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                             std::chrono::duration<double>(row[0])));
    if (pictures != room.faults.end() && ++n % int(pictures->second) == 0 &&
        !send_picture(room, client, row[0] + kEpoch_s))
      return 0;
    if (!send_row(room, client, row)) return 0;
  }
  if (!room.faults.contains("close")) std::this_thread::sleep_for(std::chrono::seconds(60));
  client->CloseSocket();
  return 0;
}
