"""The routes as the server itself describes them (/api/openapi.json), and bodies made from their schemas."""
import random

from wire import Client
from world import quoted

SCALARS = {"integer": 1, "number": 0.5, "boolean": True, "null": None}
IGNORED = {"liveStation", "live"}  # WebSockets: `transport` and `nesting` speak to them


class Route:
    def __init__(self, path, method, operation, schemas):
        self.path, self.method, self.id = path, method.upper(), operation["operationId"]
        self.roles, self.parameters = operation.get("x-roles", []), operation["parameters"]
        self.open = not operation.get("security")
        self.objects = operation.get("x-objects", {})
        content = operation.get("requestBody", {}).get("content", {})
        self.takes_json, self.takes_bytes = "application/json" in content, "application/octet-stream" in content
        self.body_schema = content.get("application/json", {}).get("schema")
        self.websocket, self.schemas = operation.get("x-websocket", False), schemas

    def address(self, values=None, choose=None):
        """The path and query with `values` by parameter name; `choose(parameter)` gives what is not there."""
        out, query = self.path, []
        for parameter in self.parameters:
            name = parameter["name"]
            value = (values or {}).get(name)
            if value is None:
                value = choose(parameter) if choose else plain_value(parameter)
            if parameter["in"] == "path":
                out = out.replace("{" + name + "}", quoted(value))
            elif parameter["in"] == "query" and (parameter["required"] or value is not None and choose):
                query.append(f"{quoted(name)}={quoted(value)}")
        return out + ("?" + "&".join(query) if query else "")

    def headers(self):
        return {p["name"]: "00000000" for p in self.parameters if p["in"] == "header"}


def plain_value(parameter):
    schema = parameter["schema"]
    if "default" in schema:
        return schema["default"]
    return schema.get("minimum", 0) if schema["type"] in ("integer", "number") else "0" * 32


def routes_of(world):
    description = Client(world.target, world.admin.credentials).must("GET", "/api/openapi.json")  # a line of its own: processes fork
    schemas = description["components"]["schemas"]
    found = [Route(path, method, operation, schemas)
             for path, methods in description["paths"].items() for method, operation in methods.items()]
    return [route for route in found if route.id not in IGNORED]


def sample(schema, schemas, draw, depth=0):
    """A value that the schema allows, as small as it may be; optional fields are there every other time."""
    if "$ref" in schema:
        schema = schemas[schema["$ref"].rsplit("/", 1)[1]]
    if "anyOf" in schema:
        return sample(draw.choice(schema["anyOf"]), schemas, draw, depth)
    if "enum" in schema:
        return draw.choice(schema["enum"])
    kind = schema.get("type", "object")
    if kind == "string":
        return draw.choice(["a", "0" * 32, "tuned", "x y z", "2026"])
    if kind == "array":
        count = schema.get("minItems", draw.randint(0, 2) if depth < 6 else 0)
        return [sample(schema.get("items", {}), schemas, draw, depth + 1) for _ in range(count)]
    if kind == "object":
        required, out = schema.get("required", []), {}
        for name, field in schema.get("properties", {}).items():
            if name in required or draw.random() < 0.5:
                out[name] = sample(field, schemas, draw, depth + 1)
        return out
    return SCALARS[kind]


def body_of(route, draw=None):
    return sample(route.body_schema, route.schemas, draw or random.Random(1))
