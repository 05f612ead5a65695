// A program that listens as 3D Slicer does, by the protocol's own library (libOpenIGTLink), and
// shares no code with ours.
//
//   igtl_listener PORT COUNT     prints each of COUNT messages as a line of JSON, then ends
#include <igtlClientSocket.h>
#include <igtlMessageHeader.h>
#include <igtlSensorMessage.h>
#include <igtlTransformMessage.h>
#include <igtl_unit.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

void print_transform(const igtl::MessageHeader::Pointer& header, igtl::ClientSocket* socket) {
  auto message = igtl::TransformMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  bool late = false;
  socket->Receive(message->GetPackBodyPointer(), message->GetPackBodySize(), late);
  const int read = message->Unpack(1);  // 1: the checksum is checked
  igtl::Matrix4x4 m;
  message->GetMatrix(m);
  std::printf("{\"type\": \"TRANSFORM\", \"device\": \"%s\", \"whole\": %s, \"m\": [",
              header->GetDeviceName(), read & igtl::MessageHeader::UNPACK_BODY ? "true" : "false");
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) std::printf("%s%.9g", r + c ? ", " : "", double(m[r][c]));
  std::printf("]}\n");
}

void print_sensor(const igtl::MessageHeader::Pointer& header, igtl::ClientSocket* socket) {
  auto message = igtl::SensorMessage::New();
  message->SetMessageHeader(header);
  message->AllocatePack();
  bool late = false;
  socket->Receive(message->GetPackBodyPointer(), message->GetPackBodySize(), late);
  const int read = message->Unpack(1);
  igtl_unit_data unit;
  igtl_unit_init(&unit);
  igtl_unit_unpack(message->GetUnit(), &unit);
  std::printf("{\"type\": \"SENSOR\", \"device\": \"%s\", \"whole\": %s, \"unit\": [",
              header->GetDeviceName(), read & igtl::MessageHeader::UNPACK_BODY ? "true" : "false");
  for (int k = 0; k < 2; ++k) std::printf("%s%d, %d", k ? ", " : "", unit.unit[k], unit.exp[k]);
  std::printf("], \"values\": [");
  for (unsigned k = 0; k < message->GetLength(); ++k)
    std::printf("%s%.17g", k ? ", " : "", message->GetValue(k));
  std::printf("]}\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  auto socket = igtl::ClientSocket::New();
  if (socket->ConnectToServer("127.0.0.1", std::atoi(argv[1])) != 0) return 1;
  for (int left = std::atoi(argv[2]); left > 0; --left) {
    auto header = igtl::MessageHeader::New();
    header->InitPack();
    bool late = false;
    const auto got = socket->Receive(header->GetPackPointer(), header->GetPackSize(), late);
    if (got != header->GetPackSize()) return 1;
    header->Unpack();
    const std::string type = header->GetDeviceType();
    if (type == "TRANSFORM") print_transform(header, socket);
    if (type == "SENSOR") print_sensor(header, socket);
  }
  socket->CloseSocket();
  return 0;
}
